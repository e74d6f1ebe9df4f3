// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/point_sums.h"

#include <cstdint>

namespace vdbmap {

Moments moments_of(const PointSums& sums) {
  const auto& v = sums.values;
  Eigen::Matrix3d products;
  products << v[4], v[7], v[8], v[7], v[5], v[9], v[8], v[9], v[6];
  Moments moments;
  moments.count = static_cast<std::int64_t>(sums.count());
  moments.mean = Eigen::Vector3d(v[1], v[2], v[3]) / sums.count();
  moments.scatter = products - sums.count() * moments.mean * moments.mean.transpose();
  return moments;
}

}  // namespace vdbmap
