// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include <nlohmann/json.hpp>

#include "parking/exchange/spaces_file.h"
#include "vdbmap/io/geodesy/geodetic_transform.h"

namespace vdbmap::parking {

/// Turns places of a map into coordinates of GeoJSON.
class GeoFrame {
 public:
  /// Throws std::invalid_argument where PROJ does not know the map's EPSG code.
  GeoFrame(const MapFrame& frame, const GeoOptions& options);

  bool is_wgs84() const { return transform_.has_value(); }

  /// Longitude, latitude to 9 decimals [deg] and height, or x, y, z to 0.1 mm: [m] in the map's system.
  nlohmann::ordered_json position(const Eigen::Vector3d& local) const;

  /// A polygon, closed and against the clock; with heights where the space's ground is known.
  nlohmann::ordered_json polygon(std::span<const Eigen::Vector2d> outline, const std::optional<double>& ground) const;

  /// The member "crs" of a collection: nothing for WGS 84 and where the map has no EPSG code.
  std::optional<nlohmann::ordered_json> crs() const;

 private:
  MapFrame frame_;
  std::optional<GeodeticTransform> transform_;
};

}  // namespace vdbmap::parking
