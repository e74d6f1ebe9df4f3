// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "parking/exchange/occupancy_files.h"

namespace vdbmap::parking {

/// What documents for cities need to know beside the spaces.
struct CityOptions {
  std::string city;                   ///< its name, from which ids are made; empty: the record's place
  std::string time_zone = "Etc/UTC";  ///< of the TZ database
  double geoid_offset = 0;            ///< [m]
};

/// Zones and spaces as in the Curb Data Specification 1.0 (Open Mobility Foundation, Curbs API): integer centimetres,
/// milliseconds since 1970, ids of UUIDv5. A zone holds the spaces of one kerb side of which each is at most 60 m from
/// the next; its outline is their convex hull. `available` is left out where the state is unknown; candidates are no
/// spaces yet and left out. Throws std::invalid_argument where the map has no EPSG code or the epoch no date.
nlohmann::ordered_json curb_data_of(const OccupancyRecord& record, const CityOptions& options);

/// FIWARE's ParkingSpot entities (Smart Data Models, NGSI-LD, simplified): a list. Throws std::invalid_argument where
/// the map has no EPSG code.
nlohmann::ordered_json fiware_of(const OccupancyRecord& record, const CityOptions& options);

}  // namespace vdbmap::parking
