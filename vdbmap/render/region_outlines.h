// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include <Eigen/Core>

#include "vdbmap/change/change_regions.h"
#include "vdbmap/render/camera.h"
#include "vdbmap/render/voxel_view.h"

namespace vdbmap {

/// Draws boxes around regions in the colours of their kinds, darkened, and the numbers of the largest; seen from
/// straight above their rectangles. `anchor` leads from the original system to the local frame.
void draw_regions(VoxelView& view, const Camera& camera, std::span<const ChangeRegion> regions,
                  const Eigen::Vector3d& anchor);

}  // namespace vdbmap
