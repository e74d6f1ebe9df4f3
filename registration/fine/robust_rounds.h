// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "registration/fine/plane_match.h"

namespace vdbmap::registration {

/// Scale of the robust kernel (Geman & McClure) from round to round [m].
struct KernelSchedule {
  double first;
  double last;
  double factor;  ///< from one round to the next, until `last`
};

/// Rounds of matching and solving with the same points, level and search.
struct MatchingStage {
  const VoxelLevel* level;
  std::span<const Eigen::Vector3d> points;  ///< [m] in the frame of the scan
  MatchOptions match;
  KernelSchedule kernel;
  int max_rounds;
};

/// Where the rounds ended, and the matches and robust weights of the last round, at that pose.
struct RoundsResult {
  Eigen::Isometry3d local_from_scan = Eigen::Isometry3d::Identity();
  std::vector<PlaneMatch> matches;
  std::vector<double> weights;
  std::vector<double>
      slopes;              ///< derivatives of weight times distance by the distance: below the weights, even negative
  bool converged = false;  ///< the last round's step, undamped, was less than 1 mm and 0.01 degrees
};

/// Matches the points with planes, lets Ceres take one step to move the scan to them, and again, until the step is
/// small by itself: one that had to be damped to that is no rest. Stops where fewer than six points have a plane.
RoundsResult run_rounds(const MatchingStage& stage, const Eigen::Isometry3d& local_from_scan_guess);

}  // namespace vdbmap::registration
