// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace vdbmap {

/// First and second moments of a set of points.
struct Moments {
  std::int64_t count = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();     ///< [m]
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();  ///< [m^2] sum of outer products about the mean

  /// Sample covariance, divisor n-1 (Mortazavi 2023, eq. 1 and 2) [m^2]; zero below two points.
  Eigen::Matrix3d covariance() const;
};

/// Moments of the union of two sets of points.
Moments merge(const Moments& a, const Moments& b);

}  // namespace vdbmap
