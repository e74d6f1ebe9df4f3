// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "registration/odometry_path.h"

namespace vdbmap::registration {

/// How far odometry may go astray on its way, and two places that were found be off however short the way is.
struct DriftModel {
  double translation = 2.0;             ///< [m] of the places
  double turn_deg = 10;                 ///< [deg] of the places
  double translation_per_metre = 0.03;  ///< [m/m] of the way
  double turn_deg_per_metre = 0.02;     ///< [deg/m] of the way: ten times what KISS-ICP does on KITTI

  /// Throws std::invalid_argument naming the value and what is allowed.
  void check() const;
};

/// What two places may differ by before odometry contradicts them.
struct DriftAllowance {
  double translation;  ///< [m]
  double turn;         ///< [rad]
};

/// After a way [m]. A turn that grows evenly along it, a = k s, bends it aside by the integral, k s^2 / 2.
DriftAllowance allowance_after(double way, const DriftModel& drift);

/// Where a batch was found.
struct BatchPlace {
  std::size_t first_scan = 0;  ///< number on the path
  Eigen::Isometry3d map_from_batch = Eigen::Isometry3d::Identity();
};

/// Which of the batches are to be believed. Each is judged among the 16 before and the 16 after it: it has to belong to
/// every longest chain in which odometry leads from each place to the next, to what it may drift between them, and that
/// chain has to hold more than half of these batches. So drift may add up along the chain, and where two chains are as
/// long, what they differ by is not believed. Each part of the path between gaps stands for itself, as nothing is known
/// across them. Expects the batches in the order of the path; time grows with their number.
std::vector<bool> believed_batches(std::span<const BatchPlace> batches, std::span<const PathPose> path,
                                   const DriftModel& drift = {});

}  // namespace vdbmap::registration
