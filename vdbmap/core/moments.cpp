// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/moments.h"

namespace vdbmap {

Eigen::Matrix3d Moments::covariance() const {
  if (count < 2) return Eigen::Matrix3d::Zero();
  return scatter / static_cast<double>(count - 1);
}

Moments merge(const Moments& a, const Moments& b) {
  if (a.count == 0) return b;
  if (b.count == 0) return a;

  const std::int64_t count = a.count + b.count;
  const double weight_b = static_cast<double>(b.count) / static_cast<double>(count);
  const Eigen::Vector3d shift = b.mean - a.mean;

  // Chan, Golub & LeVeque 1983: no cancellation of sum(x^2).
  Moments merged;
  merged.count = count;
  merged.mean = a.mean + weight_b * shift;
  merged.scatter = a.scatter + b.scatter + static_cast<double>(a.count) * weight_b * shift * shift.transpose();
  return merged;
}

}  // namespace vdbmap
