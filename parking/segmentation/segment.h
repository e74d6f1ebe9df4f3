// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "parking/segmentation/network_weights.h"
#include "parking/segmentation/surface_class.h"
#include "vdbmap/core/voxel_level.h"

namespace vdbmap::parking {

/// The class of each voxel of a level of 0.1 m, in the order of its records: the one that scores highest. Throws
/// std::invalid_argument for another voxel size.
std::vector<SurfaceClass> segment(const VoxelLevel& finest, const NetworkWeights& network);

}  // namespace vdbmap::parking
