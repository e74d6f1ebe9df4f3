// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::registration {

/// The rigid motion that brings the estimated positions closest to the true ones (Umeyama 1991, without scale), as the
/// absolute trajectory error takes for granted. Scans without one of both do not count. Nothing for fewer than three
/// scans. Where all positions lie on one line, the rotation about it is arbitrary, but not where they come to lie.
/// Throws std::invalid_argument where the trajectories differ in length.
std::optional<Eigen::Isometry3d> align_trajectory(const Trajectory& estimate, const Trajectory& truth);

/// All poses moved: target_from_map * map_from_scan.
Trajectory moved(const Trajectory& trajectory, const Eigen::Isometry3d& target_from_map);

}  // namespace vdbmap::registration
