// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/search_area.h"

#include <algorithm>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/io/vdb/map_file.h"

namespace vdbmap::cli {
namespace {

using Circle = Eigen::Vector3d;  // x, y, radius [m]

bool touches(const CityTile& tile, const Circle& circle) {
  const Eigen::Array2d center = circle.head<2>();
  const Eigen::Array2d low = tile.extent.min.head<2>();
  const Eigen::Array2d high = tile.extent.max.head<2>();
  return (center.max(low).min(high) - center).matrix().norm() <= circle.z();
}

// Places that scans may be seen from; none where that may be anywhere.
std::vector<Circle> circles_of(const SearchArea& area) {
  if (!area.near.empty()) return {{area.near[0], area.near[1], area.near[2] + area.reach}};
  std::vector<Circle> circles;
  if (!area.guesses || area.guesses->size() == 1) return circles;
  for (const std::optional<Eigen::Isometry3d>& guess : area.guesses->map_from_scan) {
    if (guess) circles.emplace_back(guess->translation().x(), guess->translation().y(), area.reach);
  }
  return circles;
}

}  // namespace

MapWindows open_search_area(const std::filesystem::path& map, const SearchArea& area) {
  if (!is_city(map)) return load_map(map);
  const std::vector<Circle> circles = circles_of(area);
  const auto is_in_reach = [&](const CityTile& tile) {
    return circles.empty() || std::ranges::any_of(circles, [&](const Circle& circle) { return touches(tile, circle); });
  };
  City city = open_city(map);
  if (std::ranges::none_of(city.manifest.tiles, is_in_reach)) {
    throw IoError::malformed(map, "has no voxels where the scans are looked for");
  }
  return MapWindows(std::move(city), is_in_reach);
}

}  // namespace vdbmap::cli
