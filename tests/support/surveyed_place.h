// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "tests/support/synthetic_scene.h"
#include "vdbmap/core/visibility.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap::test {

/// How a made-up place is surveyed: scans every other metre along a lane.
struct SurveyOptions {
  unsigned seed = 1;
  double noise = 0.01;                               ///< [m] of ranges
  double voxel_size = 0.1;                           ///< [m]
  double first_stop = -8;                            ///< [m] along the lane
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();   ///< [m] of all points, as by a wrong trajectory
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();  ///< [m]
};

/// A map and what its rays saw.
struct Survey {
  VoxelMap map;
  Visibility visibility;
};

Survey survey_of(const Scene& scene, const SurveyOptions& options = {});

/// What stands in a lane of 24 m.
struct LaneOptions {
  bool has_car = true;          ///< 4.4 m x 1.8 m x 1.5 m around (4, 2.9), 0.2 m above the road
  double wall_y = 6;            ///< [m]
  double kerb_y = 4.4;          ///< [m]
  bool has_hidden_box = false;  ///< behind a screen that hides it from the lane
};

/// Road, kerb, pavement and a wall along x, beside which one drives at y = -1.
Scene lane(const LaneOptions& options = {});

}  // namespace vdbmap::test
