// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "parking/objects/vehicles.h"
#include "parking/occupancy/occupancy.h"
#include "parking/spaces/parking_space.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap::parking {

/// What is known of the spaces of a street in one epoch.
struct OccupancyRecord {
  std::string place;     ///< name of the city or street
  std::string map_name;  ///< of the map that the spaces are of
  std::string date;      ///< ISO 8601, of the epoch; empty: not known
  MapFrame frame;
  OccupancyRule rule;
  std::vector<ParkingSpace> spaces;
  std::vector<SpaceOccupancy> states;  ///< one a space
  std::vector<Vehicle> vehicles;       ///< that the evidence speaks of
};

}  // namespace vdbmap::parking
