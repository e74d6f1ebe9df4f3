// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "parking/spaces/parking_space.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap::parking {

/// Whose coordinates a GeoJSON file has.
enum class GeoCoordinates {
  kWgs84,  ///< longitude, latitude [deg], ellipsoidal height [m] (RFC 7946); of a map without EPSG code: the map's
  kMap,    ///< the map's, and a member "crs" that says so
};

/// How positions get on the globe.
struct GeoOptions {
  GeoCoordinates coordinates = GeoCoordinates::kWgs84;
  double geoid_offset = 0;  ///< [m] ellipsoidal height minus the map's heights
};

/// Spaces of a GeoJSON file (RFC 7946): a FeatureCollection of polygons without holes. Read are the properties `id` (or
/// the feature's own, else its number from 1 on), `kerb_side` or `side`, `angle` or `kind`, `candidate` and `history`.
/// Coordinates are those that "crs" names, WGS 84 without it, or the map's
/// where the map has no EPSG code. Heights count where all corners have one that is the map's. Throws IoError
/// (malformed) naming the feature: no GeoJSON, another geometry, outlines that are none, ids that come twice, another
/// reference system than the map's, WGS 84 that the map has no EPSG code for.
std::vector<ParkingSpace> read_spaces(const std::filesystem::path& path, const MapFrame& frame,
                                      const GeoOptions& options = {});

/// Spaces as GeoJSON that read_spaces() reads. Throws std::invalid_argument where the map's EPSG code is not known to
/// PROJ.
std::string geojson_of(std::span<const ParkingSpace> spaces, const MapFrame& frame, const GeoOptions& options = {});

}  // namespace vdbmap::parking
