// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "vdbmap/core/moments.h"
#include "vdbmap/core/voxel.h"

/// Slow and plain ways to what the library computes fast.
namespace vdbmap::test {

/// The numbers of the points in each voxel.
using PointsByVoxel = std::map<VoxelIndex, std::vector<std::size_t>>;

/// Sorts points [m, original system] into the voxels of a map with this anchor.
PointsByVoxel points_by_voxel(std::span<const Eigen::Vector3d> points, double voxel_size,
                              const Eigen::Vector3d& anchor = Eigen::Vector3d::Zero());

/// Count, mean and scatter of some of the points about `origin`: first the mean, then the scatter about it, in 80 bits.
Moments two_pass_moments(std::span<const Eigen::Vector3d> points, std::span<const std::size_t> numbers,
                         const Eigen::Vector3d& origin = Eigen::Vector3d::Zero());

/// The same of all points.
Moments two_pass_moments(std::span<const Eigen::Vector3d> points);

}  // namespace vdbmap::test
