// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "registration/fine/pose_estimate.h"

namespace vdbmap::registration {

/// A scan of a sequence.
struct SequencePose {
  Eigen::Isometry3d map_from_scan_guess = Eigen::Isometry3d::Identity();  ///< where it stays if nothing holds it
  std::optional<PoseEstimate> in_map;  ///< what the map alone says of the scan, where it says something
  std::optional<Eigen::Isometry3d>
      previous_from_scan;  ///< what odometry says; nothing at the first scan and after gaps
};

/// How far a step of odometry is believed.
struct JointOptions {
  double odometry_translation = 0.03;   ///< [m] standard deviation of a step on each axis
  double odometry_rotation_deg = 0.15;  ///< [deg] the same of its rotation
  double outlier_scale = 3;  ///< standard deviations from which on a scan's own estimate is doubted (Cauchy's loss),
                             ///< and odometry between two scans of which the map says something else

  /// Throws std::invalid_argument naming the value and what is allowed.
  void check() const;
};

/// Poses of all scans at once: one problem for Ceres with a factor for what the map says of each scan, and one for what
/// odometry says of each step. A scan with little to see, or one that went astray, is carried by its neighbours. Where
/// odometry slipped between two scans that the map knows (OdometryTrust), its steps lose their weight, in the poses and
/// in the covariances. Scans that nothing holds keep their guess with an unbounded covariance (1e6); other guesses have
/// no influence.
std::vector<PoseEstimate> refine_jointly(std::span<const SequencePose> sequence, const JointOptions& options = {});

}  // namespace vdbmap::registration
