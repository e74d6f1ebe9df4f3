// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "registration/rigid_motion.h"

namespace vdbmap::registration {

/// The time that a scan took, and the motion that it was deskewed with to the frame of its first point.
struct ScanSweep {
  double first_time = 0;              ///< [s] of the first point, whose frame is that of the scan
  double middle_time = 0;             ///< [s] mean of all points
  Vector6d twist = Vector6d::Zero();  ///< as ScanMotion's

  /// Where the sensor stood at the middle time, as the scan was deskewed. A scan that is aligned with a wrong twist
  /// lies right in the middle and wrong at its first point: what is off by v there is off by v / 2 in half of its
  /// points, to either side.
  Eigen::Isometry3d first_from_middle() const { return motion_of_twist((middle_time - first_time) * twist); }
};

/// A pose of a moving sensor at a time [s].
struct TimedPose {
  double time = 0;
  Eigen::Isometry3d map_from_sensor = Eigen::Isometry3d::Identity();
};

/// The pose at `time` of a sensor whose twist changes evenly: the parabola through the poses before, at and after it in
/// the tangent space of the one at it (Sola, Deray & Atchuthan 2018, section II), a line where one of them is missing.
/// Poses that are not in the order of time count as missing; without both it stays where it is.
Eigen::Isometry3d pose_at_time(double time, const std::optional<TimedPose>& before, const TimedPose& at,
                               const std::optional<TimedPose>& after);

}  // namespace vdbmap::registration
