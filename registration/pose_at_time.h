// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "registration/rigid_motion.h"

namespace vdbmap::registration {

/// A pose of a moving sensor at a time [s].
struct TimedPose {
  double time = 0;
  Eigen::Isometry3d map_from_sensor = Eigen::Isometry3d::Identity();
};

/// The pose at `time` of a sensor whose twist changes evenly: the parabola through the poses before, at and after it in
/// the tangent space of the one at it (Sola, Deray & Atchuthan 2018, section II), a line where one of them is missing.
/// Throws std::invalid_argument where both are, and where they are not in the order of time.
Eigen::Isometry3d pose_at_time(double time, const std::optional<TimedPose>& before, const TimedPose& at,
                               const std::optional<TimedPose>& after);

/// How the sensor moves at the pose `at` [rad/s and m/s, axes of the sensor]: the derivative of that parabola. Throws
/// as pose_at_time().
Vector6d twist_at_pose(const std::optional<TimedPose>& before, const TimedPose& at,
                       const std::optional<TimedPose>& after);

}  // namespace vdbmap::registration
