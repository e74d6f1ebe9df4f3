// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "vdbmap/io/poses/trajectory_file.h"
#include "vdbmap/render/image.h"

namespace vdbmap::registration {

struct TrajectoryPlotOptions {
  std::string title = "Estimated and true trajectory";
  int width = 1600;   ///< [pixels] 1000 to kMaxImageSize
  int height = 1000;  ///< [pixels] 800 to kMaxImageSize

  /// Throws std::invalid_argument for sizes out of range.
  void check() const;
};

/// One picture of how good a trajectory is: plan view with the truth in green, the estimate in red and a mark where it
/// is missing; histograms of the XY and Z errors over the scans; the figures. Throws std::invalid_argument where the
/// trajectories differ in length or there is no true pose.
Image plot_trajectory(const Trajectory& estimate, const Trajectory& truth, const TrajectoryPlotOptions& options = {});

}  // namespace vdbmap::registration
