// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "vdbmap/core/voxel_map.h"

namespace vdbmap {

/// A parking space in one epoch, as a file of spaces says it.
struct SpaceState {
  std::string state;  ///< "occupied", "vacant", "unknown"
  std::optional<std::string> previous_state;
  double confidence = 0;
  double vehicle_points = 0;
  double rays_through = 0;
};

/// A parking space of a file.
struct SiteSpace {
  std::string id;
  std::vector<Eigen::Vector3d> outline;  ///< [m, local frame] counter-clockwise, at the ground; not closed
  double length = 0;                     ///< [m]
  double width = 0;                      ///< [m]
  double heading_deg = 0;                ///< of the length, counter-clockwise from +x
  std::string kerb_side;                 ///< may be empty
  bool is_candidate = false;
  SpaceState state;
};

/// The spaces of one epoch.
struct EpochSpaces {
  std::string date;  ///< "2023-03-02", where the file says one
  std::vector<SiteSpace> spaces;
};

/// Where spaces are to be found.
struct SpacesPlace {
  MapFrame frame;
  double geoid_offset = 0;     ///< [m] as it was when the file was written
  Eigen::AlignedBox3d bounds;  ///< of the map [m, local frame]
};

/// Reads parking spaces and their states from GeoJSON, as `vdbmap spaces` and `vdbmap occupancy` write it: polygons in
/// WGS 84, or in the map's system where a member "crs" says so or the map has no EPSG code; properties id, state,
/// previous_state, confidence, vehicle_points, rays_through, length, width, heading [rad], kerb_side, candidate, date.
/// Without a state, the last of `history` counts. Corners without a height get the lowest of the map.
///
/// Throws IoError (malformed) naming the feature: no GeoJSON, no polygon, no id or one that comes twice, another state
/// or reference system; and where no space lies within 100 m of the map.
EpochSpaces read_site_spaces(const std::filesystem::path& path, const SpacesPlace& place);

/// The spaces of several epochs as the page reads them; `epochs` are pairs of an epoch's id and its spaces. A space has
/// the outline of its last file.
std::string spaces_json(const std::vector<std::pair<std::string, EpochSpaces>>& epochs);

}  // namespace vdbmap
