// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include <Eigen/Core>

namespace vdbmap {

/// Points of a cloud that voxel ids do not reach from the anchor: they are no part of the map.
struct UnreachablePoints {
  std::size_t count = 0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();  ///< where the first of them lies, as the cloud says
  double reach = 0;                                 ///< [m] from the anchor on each axis, as far as ids reach
};

/// Throws std::out_of_range, naming the first one, where half of a cloud of `num_points` or more is not reached: that
/// is no stray point, but another place or another unit.
void check_reached(const UnreachablePoints& unreachable, std::size_t num_points);

}  // namespace vdbmap
