// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "tools/simulator/drive.h"
#include "tools/simulator/scene_view.h"
#include "tools/simulator/street.h"

namespace vdbmap::simulator {

/// What a sensor can see from where it is.
struct FieldOfView {
  Eigen::Isometry3d vehicle_from_sensor = Eigen::Isometry3d::Identity();
  double lowest = -1.6;  ///< [rad] elevation
  double highest = 1.6;  ///< [rad]
  double farthest = 60;  ///< [m]
};

/// For each parking space the share of 36 points in the room over it, up to 1.3 m, that a drive saw from some pose,
/// half a second apart; what stands in the space itself hides nothing of it.
std::vector<double> space_visibility(const Street& street, int epoch, const SceneView& view, const Drive& drive,
                                     const FieldOfView& field);

}  // namespace vdbmap::simulator
