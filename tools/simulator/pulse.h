// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tools/simulator/random.h"
#include "tools/simulator/scene_view.h"

namespace vdbmap::simulator {

/// How a laser measures.
struct PulseModel {
  double nearest = 0.5;           ///< [m]
  double farthest = 100;          ///< [m]
  double range_noise = 0;         ///< [m] standard deviation
  double divergence = 0;          ///< [rad] of the beam, its whole width; 0: no mixed pixels
  double half_range = 0;          ///< [m] where half of the pulses on 10 % of reflectance come back; 0: all do
  double random_loss = 0;         ///< share of pulses that never come back
  double merging_distance = 1.2;  ///< [m] two surfaces nearer than that make one echo
  double specks = 0;              ///< [1/m] chance of an echo of rain, near the scanner
};

/// What came back.
struct Echo {
  double range;            ///< [m] as measured
  std::uint32_t triangle;  ///< that sent most of it back; kNoTriangle for rain
  Eigen::Vector3d normal;  ///< of that surface
  double reflectivity;     ///< reflectance as the scanner believes it to be, 1 for a white wall
};

/// Sends one pulse. Windows let most of the light through; dark, glossy or grazed surfaces and far ones lose returns;
/// a beam wider than a point that meets two surfaces measures the nearer, the farther or something between.
std::optional<Echo> measure(const SceneView& view, const PulseModel& model, const Eigen::Vector3d& origin,
                            const Eigen::Vector3d& direction, RayRandom& random);

}  // namespace vdbmap::simulator
