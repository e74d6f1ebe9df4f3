// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/odometry/sensor_motion.h"

#include <algorithm>

namespace vdbmap::registration {

void SensorMotion::begin_scan(double interval, double lead) {
  first_time_ += interval;
  lead_ = lead;
}

// Scans that overlap in time may have mean times in another order.
double SensorMotion::seconds_since_registered() const {
  constexpr double kLeastInterval = 1e-3;  // [s]
  return std::max(first_time_ + lead_ - registered_mean_time_, kLeastInterval);
}

Eigen::Isometry3d SensorMotion::predicted_pose(double seconds) const {
  return map_from_registered_ * motion_of_twist(seconds * twist_);
}

Eigen::Isometry3d SensorMotion::predicted_pose() const { return predicted_pose(seconds_since_registered()); }

Vector6d SensorMotion::twist_to(const Eigen::Isometry3d& map_from_scan) const {
  return twist_of_motion(map_from_registered_.inverse() * map_from_scan) / seconds_since_registered();
}

void SensorMotion::set_pose(const Eigen::Isometry3d& map_from_scan) {
  map_from_registered_ = map_from_scan;
  registered_mean_time_ = first_time_ + lead_;
}

Eigen::Isometry3d SensorMotion::at_first_point(const Eigen::Isometry3d& map_from_scan) const {
  return map_from_scan * motion_of_twist(-lead_ * twist_);
}

}  // namespace vdbmap::registration
