// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "parking/exchange/spaces_file.h"
#include "parking/occupancy/occupancy_record.h"

namespace vdbmap::parking {

/// All that is known, for programs.
nlohmann::ordered_json json_of(const OccupancyRecord& record);

/// The spaces with their states, as GeoJSON that read_spaces() reads; this epoch is the last of their history. Throws
/// std::invalid_argument where PROJ does not know the map's EPSG code.
std::string geojson_of(const OccupancyRecord& record, const GeoOptions& options = {});

/// A table (RFC 4180) of the spaces, with the middle of each in the map's system and, where that is known, in WGS 84.
std::string csv_of(const OccupancyRecord& record, const GeoOptions& options = {});

}  // namespace vdbmap::parking
