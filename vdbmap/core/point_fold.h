// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include "vdbmap/core/point_cloud.h"
#include "vdbmap/core/voxel_block.h"

namespace vdbmap {

/// The voxels of some points in one block.
struct FoldedBlock {
  BlockKey block;
  BlockSums voxels;
};

/// Sums the points [begin, end) of a cloud by voxel; blocks in the order of their keys.
///
/// Two counting sorts, no hash map over voxels: points go to their block first (a cached table of the few blocks a
/// scan touches), then every block is sorted by voxel and folded on its own, in cache, blocks in parallel.
/// Throws std::out_of_range for a point that is not addressable.
std::vector<FoldedBlock> fold_points(const PointCloud& cloud, std::size_t begin, std::size_t end,
                                     const Eigen::Isometry3d& local_from_cloud, double voxels_per_metre);

}  // namespace vdbmap
