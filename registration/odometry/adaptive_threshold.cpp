// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/odometry/adaptive_threshold.h"

#include <cmath>

#include "registration/odometry/require_positive.h"
#include "registration/rigid_motion.h"

namespace vdbmap::registration {

double deviation_at_range(const Eigen::Isometry3d& motion, double max_range) {
  const double angle = twist_of_motion(motion).head<3>().norm();
  return 2 * max_range * std::sin(angle / 2) + motion.translation().norm();
}

AdaptiveThreshold::AdaptiveThreshold(double initial, double min_deviation, double max_range)
    : initial_(initial), min_deviation_(min_deviation), max_range_(max_range) {
  require_positive("initial threshold", initial);
  require_positive("min_deviation", min_deviation);
  require_positive("max_range", max_range);
}

double AdaptiveThreshold::sigma() const {
  return count_ == 0 ? initial_ : std::sqrt(sum_of_squares_ / static_cast<double>(count_));
}

void AdaptiveThreshold::add_deviation(const Eigen::Isometry3d& predicted_from_found) {
  const double deviation = deviation_at_range(predicted_from_found, max_range_);
  if (!(deviation > min_deviation_)) return;
  sum_of_squares_ += deviation * deviation;
  ++count_;
}

}  // namespace vdbmap::registration
