// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/city_window.h"

#include <algorithm>
#include <cerrno>
#include <exception>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "vdbmap/core/error.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/core/parallel_tasks.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/io/vdb/vdb_checksum.h"

namespace vdbmap {
namespace {

// How often a manifest is read again while writers replace one after the other.
constexpr int kMostStates = 100;

bool is_missing(const std::filesystem::path& path) {
  std::error_code error;
  return !std::filesystem::exists(path, error);
}

// Where a file goes while it is read, which readers notice in many ways, it is missing like one that went before.
template <typename Load>
auto unless_missing(const std::filesystem::path& path, const Load& load) -> std::optional<decltype(load())> {
  try {
    return load();
  } catch (const std::exception&) {
    if (is_missing(path)) return std::nullopt;
    throw;
  }
}

void check_name(const std::filesystem::path& path, const CityTile& tile) {
  if (stated_checksum(path) != tile.hash) throw IoError::malformed(path, "is not the tile that its name says");
}

VoxelMap load_checked(const City& city, const CityTile& tile) {
  const std::filesystem::path path = tile_path(city.folder, tile);
  check_name(path, tile);
  VoxelMap map = load_map(path);
  const std::string problem = tile_problem(map, tile, city.manifest.layout);
  if (!problem.empty()) throw IoError::malformed(path, problem);
  map.has_color = city.manifest.layout.has_color;
  return map;
}

// The coarser levels are the manifest's; of the finest, which takes most of the time, nothing is known.
VoxelMap load_coarser_checked(const City& city, const CityTile& tile) {
  const std::filesystem::path path = tile_path(city.folder, tile);
  check_name(path, tile);
  VoxelMap map = load_coarser_levels(path);
  const CityLayout& layout = city.manifest.layout;
  map.levels.insert(map.levels.begin(), VoxelLevel(layout.voxel_sizes.front(), {}, {}));
  map.has_color = layout.has_color;
  std::vector<double> voxel_sizes;
  std::vector<std::uint64_t> num_voxels = {tile.num_voxels.front()};
  for (const VoxelLevel& level : map.levels) voxel_sizes.push_back(level.voxel_size());
  for (std::size_t i = 1; i < map.levels.size(); ++i) num_voxels.push_back(map.levels[i].size());
  if (map.frame != layout.frame) throw IoError::malformed(path, "has another anchor or EPSG code than the city");
  if (voxel_sizes != layout.voxel_sizes) throw IoError::malformed(path, "has other levels than the city");
  if (num_voxels != tile.num_voxels) throw IoError::malformed(path, "holds other voxels than the manifest counts");
  return map;
}

std::vector<CityTile> chosen_tiles(const CityManifest& manifest, const TileChoice& is_wanted) {
  std::vector<CityTile> tiles;
  std::ranges::copy_if(manifest.tiles, std::back_inserter(tiles), is_wanted);
  return tiles;
}

VoxelMap without_voxels(const CityLayout& layout) {
  VoxelMap map = empty_map(layout.frame, layout.voxel_sizes);
  map.has_color = layout.has_color;
  map.label_scheme = layout.label_scheme;
  return map;
}

// The chosen tiles as `load` loads each, or nothing where it is missing.
template <typename Load>
VoxelMap load_tiles(City& city, const TileChoice& is_wanted, const Load& load) {
  for (int state = 0; state < kMostStates; ++state) {
    const std::vector<CityTile> tiles = chosen_tiles(city.manifest, is_wanted);
    std::vector<std::optional<VoxelMap>> loaded(tiles.size());
    parallel_tasks(tiles.size(), [&](std::size_t i) { loaded[i] = load(tiles[i]); });
    const auto missing = std::ranges::find(loaded, false, &std::optional<VoxelMap>::has_value);
    if (missing == loaded.end()) {
      std::vector<VoxelMap> maps;
      for (std::optional<VoxelMap>& map : loaded) maps.push_back(std::move(*map));
      if (maps.size() == 1) return std::move(maps.front());
      return maps.empty() ? without_voxels(city.manifest.layout) : splice(maps);
    }
    const CityTile& tile = tiles[static_cast<std::size_t>(missing - loaded.begin())];
    if (!reopen(city)) throw IoError::malformed(tile_path(city.folder, tile), "is missing");
  }
  throw IoError::system(city.folder, "cannot be read while it changes all the time", EBUSY);
}

}  // namespace

std::string tile_problem(const VoxelMap& map, const CityTile& tile, const CityLayout& layout) {
  CityLayout found = layout_of(map, layout.density);
  if (map.finest().size() == 0) {  // of attributes nothing is known
    found.has_color = layout.has_color;
    found.channels = layout.channels;
  }
  if (found.label_scheme != layout.label_scheme) return "has labels of another scheme than the city";
  if (found.frame != layout.frame) return "has another anchor or EPSG code than the city";
  if (found.voxel_sizes != layout.voxel_sizes) return "has other levels than the city";
  if (found != layout) return "has other attributes than the city";
  const CityTile counted = describe_tile(tile.id, map);
  const bool is_counted = counted.num_points == tile.num_points && counted.num_voxels == tile.num_voxels &&
                          counted.extent.min == tile.extent.min && counted.extent.max == tile.extent.max;
  if (!is_counted) return "holds other voxels than the manifest counts";
  if (map.finest().size() > 0 && tiles_of(map) != std::vector{tile.id}) return "holds voxels of other tiles";
  return "";
}

std::optional<VoxelMap> load_tile(const City& city, const CityTile& tile) {
  return unless_missing(tile_path(city.folder, tile), [&] { return load_checked(city, tile); });
}

VoxelMap load_present_tile(const City& city, const CityTile& tile) {
  std::optional<VoxelMap> map = load_tile(city, tile);
  if (!map) throw IoError::malformed(tile_path(city.folder, tile), "is missing");
  return std::move(*map);
}

VoxelMap load_window(City& city, const TileChoice& is_wanted) {
  return load_tiles(city, is_wanted, [&](const CityTile& tile) { return load_tile(city, tile); });
}

VoxelMap load_coarser_window(City& city, const TileChoice& is_wanted) {
  return load_tiles(city, is_wanted, [&](const CityTile& tile) {
    return unless_missing(tile_path(city.folder, tile), [&] { return load_coarser_checked(city, tile); });
  });
}

VoxelMap load_city(City& city) {
  return load_window(city, [](const CityTile&) { return true; });
}

VoxelMap load_map_or_city(const std::filesystem::path& path) {
  if (!is_city(path)) return load_map(path);
  City city = open_city(path);
  return load_city(city);
}

TileChoice tiles_in_box(const Extent& box) {
  return [box](const CityTile& tile) {
    return tile.extent.min.x() <= box.max.x() && box.min.x() <= tile.extent.max.x() &&
           tile.extent.min.y() <= box.max.y() && box.min.y() <= tile.extent.max.y();
  };
}

}  // namespace vdbmap
