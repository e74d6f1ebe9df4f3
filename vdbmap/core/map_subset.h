// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>

#include "vdbmap/core/voxel_map.h"

namespace vdbmap {

/// The voxels of a map's finest level whose records `is_kept`; records as they are, normals included, which keep what
/// they saw of voxels that are gone. Coarser levels are made anew.
VoxelMap keep_voxels(const VoxelMap& map, const std::function<bool(std::size_t record)>& is_kept);

}  // namespace vdbmap
