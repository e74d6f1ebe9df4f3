// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include <Eigen/Core>

#include "vdbmap/core/moments.h"
#include "vdbmap/core/voxel_record.h"

namespace vdbmap {

/// Count, sum of positions [m] and of their products [m^2] about an origin that lies near, so that nothing cancels;
/// padded to whole vector registers.
struct alignas(32) PointSums {
  std::array<double, 12> values{};  ///< n, x y z, xx yy zz xy xz yz

  double count() const { return values[0]; }

  void add(const PointSums& other) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += other.values[i];
  }
};

/// The sums of the points of a voxel whose mean lies at `mean` [m] from the origin.
inline PointSums sums_of(const VoxelRecord& record, const Eigen::Vector3d& mean) {
  const double n = record.count;
  const Eigen::Vector3d sum = n * mean;
  const auto& c = record.covariance;
  return {{n, sum.x(), sum.y(), sum.z(), (n - 1) * c[0] + sum.x() * mean.x(), (n - 1) * c[1] + sum.y() * mean.y(),
           (n - 1) * c[2] + sum.z() * mean.z(), (n - 1) * c[3] + sum.x() * mean.y(),
           (n - 1) * c[4] + sum.x() * mean.z(), (n - 1) * c[5] + sum.y() * mean.z()}};
}

/// Their moments, mean [m] from the origin; of one point at least.
Moments moments_of(const PointSums& sums);

}  // namespace vdbmap
