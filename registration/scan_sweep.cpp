// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/scan_sweep.h"

namespace vdbmap::registration {

Eigen::Isometry3d pose_at_time(double time, const std::optional<TimedPose>& before, const TimedPose& at,
                               const std::optional<TimedPose>& after) {
  const auto twist_to = [&](const TimedPose& pose) {
    return twist_of_motion(at.map_from_sensor.inverse() * pose.map_from_sensor);
  };
  const bool has_before = before && before->time < at.time;
  const bool has_after = after && after->time > at.time;
  const double s = time - at.time;
  const double a = has_before ? before->time - at.time : 0;
  const double b = has_after ? after->time - at.time : 0;
  Vector6d twist = Vector6d::Zero();
  if (has_before) twist += s / a * (has_after ? (s - b) / (a - b) : 1) * twist_to(*before);
  if (has_after) twist += s / b * (has_before ? (s - a) / (b - a) : 1) * twist_to(*after);
  return at.map_from_sensor * motion_of_twist(twist);
}

}  // namespace vdbmap::registration
