// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/pose_at_time.h"

#include <stdexcept>

namespace vdbmap::registration {
namespace {

void check_order(const std::optional<TimedPose>& before, const TimedPose& at, const std::optional<TimedPose>& after) {
  if (!before && !after) throw std::invalid_argument("a pose between poses needs one before or after it");
  if ((before && before->time >= at.time) || (after && after->time <= at.time)) {
    throw std::invalid_argument("the poses are not in the order of time");
  }
}

Vector6d twist_to(const TimedPose& pose, const TimedPose& at) {
  return twist_of_motion(at.map_from_sensor.inverse() * pose.map_from_sensor);
}

}  // namespace

Eigen::Isometry3d pose_at_time(double time, const std::optional<TimedPose>& before, const TimedPose& at,
                               const std::optional<TimedPose>& after) {
  check_order(before, at, after);
  const double s = time - at.time;
  const double a = before ? before->time - at.time : 0;
  const double b = after ? after->time - at.time : 0;
  Vector6d twist = Vector6d::Zero();
  if (before) twist += s / a * (after ? (s - b) / (a - b) : 1) * twist_to(*before, at);
  if (after) twist += s / b * (before ? (s - a) / (b - a) : 1) * twist_to(*after, at);
  return at.map_from_sensor * motion_of_twist(twist);
}

Vector6d twist_at_pose(const std::optional<TimedPose>& before, const TimedPose& at,
                       const std::optional<TimedPose>& after) {
  check_order(before, at, after);
  const double a = before ? before->time - at.time : 0;
  const double b = after ? after->time - at.time : 0;
  Vector6d twist = Vector6d::Zero();
  if (before) twist += 1 / a * (after ? b / (b - a) : 1) * twist_to(*before, at);
  if (after) twist += 1 / b * (before ? a / (a - b) : 1) * twist_to(*after, at);
  return twist;
}

}  // namespace vdbmap::registration
