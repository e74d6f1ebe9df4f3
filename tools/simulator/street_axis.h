// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include <Eigen/Core>

#include "tools/simulator/hills.h"
#include "tools/simulator/random.h"

namespace vdbmap::simulator {

/// The middle of the street: along the station s [m] from its beginning it winds a little, rises and sags. The scene
/// frame is that of UTM (x east, y north, z up) moved to `origin`.
struct StreetAxis {
  Eigen::Vector3d origin;                           ///< [m, EPSG:25832 and height]
  double heading;                                   ///< [rad] of the street as a whole, from east to north
  double bend_amplitude;                            ///< [m] of a sine
  double bend_length;                               ///< [m] its wave
  double bend_phase;                                ///< [rad]
  double slope;                                     ///< rise by length
  double sag_amplitude;                             ///< [m]
  double sag_length;                                ///< [m]
  Eigen::Vector2d start = Eigen::Vector2d::Zero();  ///< [m, scene frame] of station 0
  std::optional<Hills> hills = std::nullopt;        ///< that it follows instead of slope and sag

  /// Direction of travel at a station [rad].
  double heading_at(double station) const;

  /// The place `offset` [m] to the left of the axis [m, scene frame], without height.
  Eigen::Vector2d point(double station, double offset) const;

  /// Height of the axis [m, scene frame].
  double height(double station) const;
};

/// A street somewhere in Hannover.
StreetAxis make_axis(Random& random);

/// One that may wind, rise and sag more.
StreetAxis make_rough_axis(Random& random);

}  // namespace vdbmap::simulator
