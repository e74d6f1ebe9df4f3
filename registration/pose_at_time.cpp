// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/pose_at_time.h"

#include <stdexcept>

#include "registration/rigid_motion.h"

namespace vdbmap::registration {

Eigen::Isometry3d pose_at_time(double time, const std::optional<TimedPose>& before, const TimedPose& at,
                               const std::optional<TimedPose>& after) {
  const auto twist_to = [&](const TimedPose& pose) {
    return twist_of_motion(at.map_from_sensor.inverse() * pose.map_from_sensor);
  };
  if (!before && !after) throw std::invalid_argument("a pose between poses needs one before or after it");
  if ((before && before->time >= at.time) || (after && after->time <= at.time)) {
    throw std::invalid_argument("the poses are not in the order of time");
  }
  const double s = time - at.time;
  const double a = before ? before->time - at.time : 0;
  const double b = after ? after->time - at.time : 0;
  Vector6d twist = Vector6d::Zero();
  if (before) twist += s / a * (after ? (s - b) / (a - b) : 1) * twist_to(*before);
  if (after) twist += s / b * (before ? (s - a) / (b - a) : 1) * twist_to(*after);
  return at.map_from_sensor * motion_of_twist(twist);
}

}  // namespace vdbmap::registration
