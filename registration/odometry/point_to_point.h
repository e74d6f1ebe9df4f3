// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include <Eigen/Geometry>

#include "registration/odometry/local_map.h"
#include "registration/rigid_motion.h"

namespace vdbmap::registration {

/// Which points match, and how much they count.
struct MatchLimits {
  double max_distance = 6;       ///< [m] a point farther from the map has no match
  double kernel = 2.0 / 3;       ///< kappa of the kernel of Geman and McClure [m^2]
  double inlier_distance = 0.5;  ///< [m] a match as near counts as inlier

  /// Throws std::invalid_argument naming the value and what is allowed.
  void check() const;
};

/// The points of a scan at a pose, each with the nearest point of the map: residual r = map_from_scan p - q [m], cost
/// kappa r^2 / 2 / (kappa + r^2), weight w = kappa^2 / (kappa + r^2)^2 (Vizzo 2023, section III-D, times kappa).
/// Derivatives are by a motion as in moved_by().
struct MatchSums {
  double cost = 0;                          ///< [m^2]
  Vector6d gradient = Vector6d::Zero();     ///< of the cost: sum of w J^T r
  Matrix6d information = Matrix6d::Zero();  ///< sum of w J^T J
  std::size_t num_matches = 0;
  std::size_t num_inliers = 0;
};

/// The same for any number of threads.
MatchSums sum_matches(std::span<const Eigen::Vector3d> points_in_scan, const LocalMap& map,
                      const Eigen::Isometry3d& map_from_scan, const MatchLimits& limits);

/// Covariance of the pose at which the points match: rotation [rad^2] about the sensor, then translation [m^2], axes of
/// the map. The sandwich of White (1980), so that the spread of the residuals counts as it is. Nothing where the points
/// do not determine the pose.
std::optional<Matrix6d> match_covariance(std::span<const Eigen::Vector3d> points_in_scan, const LocalMap& map,
                                         const Eigen::Isometry3d& map_from_scan, const MatchLimits& limits);

/// How a scan is moved to the map.
struct PointToPointOptions {
  MatchLimits limits;
  int max_iterations = 500;
  double convergence = 1e-4;  ///< norm of the last motion, rotation [rad] and translation [m] (Vizzo 2023, table I)
};

/// Where the points of a scan came to rest.
struct PointToPointResult {
  Eigen::Isometry3d map_from_scan = Eigen::Isometry3d::Identity();
  MatchSums matches;  ///< at that pose
  int num_iterations = 0;
  bool converged = false;
};

/// Point-to-point alignment from a guess (Vizzo 2023, section III-D): each point is matched with the nearest of the
/// map, the scan is moved to them, and again. Ends early where fewer than six points match. Throws
/// std::invalid_argument for bad options.
PointToPointResult align_points(std::span<const Eigen::Vector3d> points_in_scan, const LocalMap& map,
                                const Eigen::Isometry3d& map_from_scan_guess, const PointToPointOptions& options = {});

}  // namespace vdbmap::registration
