// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include <Eigen/Geometry>

#include "registration/fine/plane_match.h"
#include "registration/rigid_motion.h"

namespace vdbmap::registration {

/// One step of Levenberg and Marquardt.
struct SolverStep {
  Vector6d motion = Vector6d::Zero();  ///< as in moved_by(); zero where no step made the sum of squares smaller
  Vector6d proposed =
      Vector6d::Zero();       ///< the undamped step, also if it was rejected: what tells whether a scan rests
  bool was_rejected = false;  ///< the undamped step made the sum of squares greater
};

/// The step of Ceres' TinySolver that moves the scan towards its planes. One that makes things worse is damped until
/// one makes them better. `weights` has one entry a match.
SolverStep step_towards_planes(std::span<const PlaneMatch> matches, std::span<const double> weights,
                               const Eigen::Isometry3d& local_from_scan);

}  // namespace vdbmap::registration
