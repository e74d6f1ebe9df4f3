// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "parking/objects/upright_box.h"

namespace vdbmap::parking {

/// What is known of a space in one epoch.
enum class SpaceState { kUnknown, kVacant, kOccupied };

/// "unknown", "vacant", "occupied".
std::string_view text_of(SpaceState state);

/// The state of a text of text_of(), or nothing.
std::optional<SpaceState> space_state_of(std::string_view text);

/// How cars stand to the kerb.
enum class ParkingAngle { kUnknown, kParallel, kPerpendicular, kAngled };

/// "", "parallel", "perpendicular", "angled".
std::string_view text_of(ParkingAngle angle);

/// The angle of such a text, or nothing.
std::optional<ParkingAngle> parking_angle_of(std::string_view text);

/// The state of a space in an earlier epoch.
struct PastState {
  std::string date;  ///< ISO 8601, empty where it is not known
  SpaceState state = SpaceState::kUnknown;
};

/// A place for one vehicle.
struct ParkingSpace {
  std::string id;
  std::vector<Eigen::Vector2d> outline;  ///< [m, local frame] corners of a simple polygon, against the clock
  std::optional<double> ground;          ///< [m, local frame] its height, where it is known
  double length = 0;                     ///< [m] of the smallest rectangle around it
  double width = 0;                      ///< [m]
  double heading = 0;                    ///< [rad] of the length, from +x towards +y, 0 to pi
  std::string kerb_side;  ///< "N", "NE", ...: on which side of the road it lies; or what a city calls it; or empty
  ParkingAngle angle = ParkingAngle::kUnknown;
  bool is_candidate = false;       ///< free kerb on which no vehicle was seen so far
  std::vector<PastState> history;  ///< by time
};

/// A space with this outline, its size and heading those of the smallest rectangle around it.
ParkingSpace space_of_outline(std::vector<Eigen::Vector2d> outline);

/// The smallest rectangle around a space, without height.
UprightBox box_of(const ParkingSpace& space);

/// Area that the rectangles of two spaces share, as a share of the smaller one.
double shared_area(const UprightBox& a, const UprightBox& b);

}  // namespace vdbmap::parking
