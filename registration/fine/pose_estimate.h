// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>

#include "registration/rigid_motion.h"

namespace vdbmap::registration {

/// A pose and how well it is known.
struct PoseEstimate {
  Eigen::Isometry3d map_from_scan = Eigen::Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Identity();  ///< of a motion as in moved_by(): [rad^2] and [m^2], axes of the map
};

/// The pose of what moves rigidly with the scan.
PoseEstimate carried(const PoseEstimate& scan, const Eigen::Isometry3d& scan_from_other);

}  // namespace vdbmap::registration
