// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "tools/simulator/street_layout.h"
#include "tools/simulator/vehicle_shape.h"
#include "tools/simulator/world.h"

namespace vdbmap::simulator {

/// A place for one car.
struct ParkingSpace {
  std::size_t side;  ///< of the layout
  double station;    ///< [m] of its middle
  double distance;   ///< [m] of its middle from the axis
  double yaw;        ///< [rad] of a car that stands in it, against the direction of the stations
  double length;     ///< [m]
  double width;      ///< [m]
  bool in_car_park = false;
  std::size_t street = 0;  ///< of a quarter
};

/// In no space.
inline constexpr std::size_t kNoSpace = static_cast<std::size_t>(-1);

/// A vehicle that stands in a space for some epochs, or elsewhere.
struct ParkedVehicle {
  ObjectId object;
  VehicleShape shape;
  MaterialId paint;
  Eigen::Isometry3d scene_from_vehicle;  ///< x forward, y left, wheels on z = 0
  std::size_t space;                     ///< kNoSpace: in a driveway, a side street, a second row
  double open_door = 0;                  ///< [rad] how far a front door stands open, left positive
};

/// Spaces and, for every epoch, the vehicle that stands in each, as an index of `vehicles`.
struct Parking {
  std::vector<ParkingSpace> spaces;
  std::vector<ParkedVehicle> vehicles;
  std::vector<std::vector<std::optional<std::size_t>>> vehicle_in_space;  ///< [epoch][space]
  std::vector<std::vector<std::size_t>> elsewhere;                        ///< [epoch] vehicles that stand in no space
  /// [epoch][space] the thing that blocks a space, where one does; empty on an ideal street.
  std::vector<std::vector<std::optional<ObjectId>>> thing_in_space;
};

/// Adds the spaces of one more street of a quarter, and who parks there.
void append_parking(Parking& parking, World& world, const StreetLayout& layout, std::size_t street,
                    const StreetOptions& options);

/// The spaces between driveways and side streets, and who parks there.
Parking make_parking(World& world, const StreetLayout& layout, const StreetOptions& options);

}  // namespace vdbmap::simulator
