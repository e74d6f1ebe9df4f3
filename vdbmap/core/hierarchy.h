// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "vdbmap/core/voxel_map.h"

namespace vdbmap {

/// The level whose voxels are `factor` times as long: count, mean, covariance and colour of each are those of all
/// points in its children, merged from their moments; normals included. Channels: mean intensity, the label of the
/// children with most points, earliest first epoch, latest last epoch.
VoxelLevel coarsen(const VoxelLevel& fine, std::int32_t factor);

/// The same for voxels of `voxel_size` [m], which need not be a size that maps may have.
VoxelLevel coarsen(const VoxelLevel& fine, std::int32_t factor, double voxel_size);

/// Appends the levels of voxel_sizes[1], voxel_sizes[2], ... to a map that has the finest level alone.
void add_coarser_levels(VoxelMap& map, const std::vector<double>& voxel_sizes);

}  // namespace vdbmap
