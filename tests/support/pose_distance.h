// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace vdbmap::test {

/// How far two poses are from each other.
struct PoseDistance {
  double translation;   ///< [m]
  double rotation_deg;  ///< [deg] 0..180
};

inline PoseDistance distance_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  const Eigen::Quaterniond turn(a.linear().transpose() * b.linear());
  const double angle = 2 * std::atan2(turn.vec().norm(), std::abs(turn.w()));
  return {(a.translation() - b.translation()).norm(), angle * 180 / std::numbers::pi};
}

}  // namespace vdbmap::test
