// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "parking/ground_plan.h"
#include "parking/spaces/parking_space.h"

namespace vdbmap::parking {

/// Spaces along one kerb.
struct KerbRow {
  std::vector<std::size_t> spaces;                       ///< their numbers, in order along `direction`
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  ///< unit, along the kerb, towards +x (+y where it goes north)
  ParkingAngle angle = ParkingAngle::kUnknown;
  std::string side;  ///< of the road: "N", "NE", ..., "NW" (+y is north); empty where nothing tells
};

/// Rows of spaces: neighbours that stand in the same way, at most 25 m apart along the street and 1 m across (and 3 %
/// of their distance, in bends). The street goes where the spaces within 40 m go. The road is where the ground lies
/// lower than behind the kerb, where another row lies, and where more ground is seen. Sorted by their first spaces.
std::vector<KerbRow> find_kerb_rows(std::span<const ParkingSpace> spaces, const GroundPlan& ground);

/// Whether one or two vehicles stand between the kerbs of a street, rows of three or more on both of their sides: in
/// the lane, where nobody parks.
bool is_in_lane(const KerbRow& row, std::span<const KerbRow> rows, std::span<const ParkingSpace> spaces);

/// Half of what a space takes along a direction [m].
double half_extent(const ParkingSpace& space, const Eigen::Vector2d& direction);

/// The middle of the smallest rectangle around a space [m, local frame].
Eigen::Vector2d middle_of(const ParkingSpace& space);

}  // namespace vdbmap::parking
