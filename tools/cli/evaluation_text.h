// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "registration/evaluation/relative_error.h"
#include "registration/trajectory_error.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::cli {

/// All that `vdbmap evaluate` finds out about a trajectory.
struct Evaluation {
  registration::TrajectoryError absolute;                ///< in the frame of the map
  std::optional<Eigen::Isometry3d> truth_from_estimate;  ///< where enough poses are there to align
  std::optional<registration::TrajectoryError> aligned;  ///< after it
  std::vector<registration::RelativeError> over_short_lengths;
  std::vector<registration::RelativeError> over_kitti_lengths;
  std::size_t num_unmatched = 0;   ///< estimates whose time is near no true one
  std::size_t num_not_judged = 0;  ///< true poses at whose time no scan was taken
};

/// Compares an estimate with as many true poses.
Evaluation evaluate(const Trajectory& estimate, const Trajectory& truth);

std::string text_of(const Evaluation& evaluation);
nlohmann::ordered_json json_of(const Evaluation& evaluation);

}  // namespace vdbmap::cli
