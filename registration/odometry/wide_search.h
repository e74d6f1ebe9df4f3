// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include <Eigen/Geometry>

#include "registration/odometry/local_map.h"
#include "registration/odometry/point_to_point.h"

namespace vdbmap::registration {

/// How far around a guess a scan is looked for.
struct WideSearchOptions {
  double radius = 15;      ///< [m] level
  double step = 1;         ///< [m] between the places tried; alignment closes the gaps
  double max_turn = 0.4;   ///< [rad] about the vertical, to either side
  double turn_step = 0.2;  ///< [rad]
  int num_candidates = 8;  ///< the best places, which are aligned and compared
};

/// Finds a scan that is not where its motion leads to, after a gap for example: the places and headings around the
/// guess where most points lie near the map, each aligned; of these the one with the most inliers. The map's z axis is
/// taken to be vertical. The caller judges whether the result can be believed. The same for any number of threads.
PointToPointResult search_widely(std::span<const Eigen::Vector3d> points_in_scan, const LocalMap& map,
                                 const Eigen::Isometry3d& map_from_scan_guess, const PointToPointOptions& alignment,
                                 const WideSearchOptions& options = {});

}  // namespace vdbmap::registration
