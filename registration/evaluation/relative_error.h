// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "registration/trajectory_error.h"

namespace vdbmap::registration {

/// Lengths for drift over short ways [m]; from every scan on.
inline constexpr double kShortLengths[] = {1, 5, 10, 50};
/// Lengths of KITTI's odometry benchmark [m], whose segments start at every tenth scan.
inline constexpr double kKittiLengths[] = {100, 200, 300, 400, 500, 600, 700, 800};
inline constexpr std::size_t kKittiStartStep = 10;

/// Errors of the motion over segments of one length.
struct RelativeError {
  double length = 0;             ///< [m] nominal: what percentages and deg/m are divided by
  double driven = 0;             ///< [m] mean way along the truth: longer by up to a step between scans
  std::size_t num_segments = 0;  ///< with both estimates
  std::size_t num_missing = 0;   ///< segments whose first or last scan has no estimate
  ErrorSummary translation;      ///< [m]
  ErrorSummary rotation_deg;     ///< [deg]

  double translation_percent() const { return 100 * translation.mean / length; }
  double rotation_deg_per_m() const { return rotation_deg.mean / length; }
};

/// Drift as KITTI's development kit defines it (Geiger 2012): a segment runs from a scan to the first one more than
/// `length` farther along the true path; its error is what remains between the estimated and the true motion over it.
/// Segments start at every `start_step`-th scan. Lengths without a segment are left out. Throws std::invalid_argument
/// where the trajectories differ in length, and for lengths and steps that are not above 0.
std::vector<RelativeError> relative_errors(const Trajectory& estimate, const Trajectory& truth,
                                           std::span<const double> lengths, std::size_t start_step = 1);

/// The benchmark's two figures: means over the segments of all lengths.
struct KittiScore {
  double translation_percent = 0;
  double rotation_deg_per_m = 0;
  std::size_t num_segments = 0;  ///< without one the figures are nan
};
KittiScore kitti_score(std::span<const RelativeError> errors);

}  // namespace vdbmap::registration
