// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::registration {

/// How far one estimated pose is from the true one, in the frame of the map.
struct PoseError {
  double xy = 0;            ///< [m]
  double z = 0;             ///< [m] estimate above the truth: positive
  double translation = 0;   ///< [m] in three dimensions
  double rotation_deg = 0;  ///< [deg] angle of the rotation between them, 0..180
};

/// How far an estimate is from the truth.
PoseError pose_error(const Eigen::Isometry3d& map_from_estimate, const Eigen::Isometry3d& map_from_truth);

/// Statistics of absolute values; nan where there is none.
struct ErrorSummary {
  double median = std::numeric_limits<double>::quiet_NaN();
  double mean = std::numeric_limits<double>::quiet_NaN();
  double rms = std::numeric_limits<double>::quiet_NaN();
  double max = std::numeric_limits<double>::quiet_NaN();
};

/// The statistics of values; their signs do not count.
ErrorSummary summarize(std::vector<double> values);

/// A pose counts as found when it is at most so far off in both.
struct SuccessThreshold {
  double translation = 0;   ///< [m]
  double rotation_deg = 0;  ///< [deg]
};
constexpr SuccessThreshold kFineSuccess{0.1, 0.5};
constexpr SuccessThreshold kCoarseSuccess{2, 5};

struct TrajectoryError {
  std::vector<std::optional<PoseError>> poses;  ///< one a scan; nothing where the estimate or the truth has no pose
  std::size_t num_judged = 0;                   ///< scans with a true pose
  std::size_t num_missing = 0;                  ///< of these, the ones without an estimate
  ErrorSummary xy;                              ///< [m]
  ErrorSummary z;                               ///< [m]
  ErrorSummary translation;                     ///< [m]
  ErrorSummary rotation_deg;                    ///< [deg]
};

/// Compares pose by pose, without aligning the trajectories to each other. Throws std::invalid_argument where they
/// differ in length.
TrajectoryError evaluate_trajectory(const Trajectory& estimate, const Trajectory& truth);

/// Share, 0..1, of the judged scans whose estimate is within the threshold. A missing estimate is a failure.
double success_rate(const TrajectoryError& error, const SuccessThreshold& threshold);

}  // namespace vdbmap::registration
