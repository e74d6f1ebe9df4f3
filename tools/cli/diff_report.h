// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "vdbmap/change/change_regions.h"
#include "vdbmap/change/map_diff.h"

namespace vdbmap::cli {

/// A diff as people and programs read it.
struct DiffReport {
  std::string earlier;  ///< names of the two maps
  std::string later;
  const MapDiff& diff;
  const std::vector<ChangeRegion>& regions;
};

/// Like `git diff --stat`: a line for each of the largest regions, and one that sums up.
std::string text_of(const DiffReport& report);

/// `voxels` and `regions`; coordinates in the original system, yaw in degrees to the left of +x.
nlohmann::ordered_json json_of(const DiffReport& report);

/// A line a region, with the names of `regions` in the JSON.
std::string csv_of(const DiffReport& report);

/// The outlines of the regions in plan, WGS 84 (RFC 7946). Throws std::invalid_argument where the maps' EPSG code is
/// not known, or not to PROJ.
nlohmann::ordered_json geojson_of(const DiffReport& report);

}  // namespace vdbmap::cli
