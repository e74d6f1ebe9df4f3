// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "registration/fine/joint_refinement.h"

namespace vdbmap::registration {

/// What a step of odometry counts beside the map.
struct StepWeights {
  double rotation = 1;     ///< of the squared error, 0 to 1
  double translation = 1;  ///< the same
};

/// Where map and odometry agree, and where they do not.
struct OdometryTrust {
  std::vector<StepWeights> weights;      ///< of the step that leads to each scan
  std::vector<Eigen::Isometry3d> start;  ///< of each scan: what the map says of it, or odometry from the nearest scan
                                         ///< that the map knows; its guess where there is none
};

/// Compares every way that odometry takes between two scans that the map knows with what the map says of it. A scan
/// that lies elsewhere than odometry from both sides says went astray; where only one way disagrees, it was odometry
/// that slipped. So the fewest faults are found that explain all disagreements, by dynamic programming along each run
/// of steps. Nothing tells which step of a way slipped: all of them lose the weight, so that the scans between count as
/// little known as they are. Needs no guesses. `scans` as for refine_jointly().
OdometryTrust trust_odometry(std::span<const SequencePose> scans, const JointOptions& options);

}  // namespace vdbmap::registration
