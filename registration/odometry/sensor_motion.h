// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>

#include "registration/rigid_motion.h"

namespace vdbmap::registration {

/// The motion of a sensor from scan to scan, taken to go on with a constant twist. Poses are those at the mean time of
/// a scan's points, unless said otherwise.
///
/// At the first point, a wrong twist would skew a scan by half its way on average, which the pose makes up for with the
/// opposite sign, the next twist with twice that: from scan to scan the error would swing and grow. At the mean time
/// the average skew is zero.
class SensorMotion {
 public:
  /// A scan begins: `interval` [s] after the one before, with a mean time `lead` [s] after its first point.
  void begin_scan(double interval, double lead);

  /// Where the motion leads to.
  Eigen::Isometry3d predicted_pose() const;

  /// Where it leads to in `seconds` from the last registered scan.
  Eigen::Isometry3d predicted_pose(double seconds) const;

  /// The twist [per second] that would have led to this pose.
  Vector6d twist_to(const Eigen::Isometry3d& map_from_scan) const;

  /// The scan is here; later ones are predicted from it.
  void set_pose(const Eigen::Isometry3d& map_from_scan);
  /// The registered scan is here instead.
  void correct_registered(const Eigen::Isometry3d& map_from_registered) { map_from_registered_ = map_from_registered; }
  void set_twist(const Vector6d& twist) { twist_ = twist; }
  const Vector6d& twist() const { return twist_; }

  /// The pose of the scan at its first point.
  Eigen::Isometry3d at_first_point(const Eigen::Isometry3d& map_from_scan) const;

 private:
  double seconds_since_registered() const;

  Eigen::Isometry3d map_from_registered_ = Eigen::Isometry3d::Identity();
  double registered_mean_time_ = 0;  // [s] since the first scan
  double first_time_ = 0;            // [s] of the current scan
  double lead_ = 0;                  // [s]
  Vector6d twist_ = Vector6d::Zero();
};

}  // namespace vdbmap::registration
