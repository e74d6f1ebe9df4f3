// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/web/site_source.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/core/parallel_tasks.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/store/city_window.h"

namespace vdbmap {
namespace {

bool reaches_into(const TileId& tile, const openvdb::CoordBBox& box, std::int32_t per_tile) {
  return tile.x * per_tile <= box.max().x() && box.min().x() < (tile.x + 1) * per_tile &&
         tile.y * per_tile <= box.max().y() && box.min().y() < (tile.y + 1) * per_tile;
}

// What is wanted of a tile; the rest of it is forgotten at once.
VoxelMap load_part(const City& city, const CityTile& tile, const openvdb::CoordBBox& box) {
  std::optional<VoxelMap> map = load_tile(city, tile);
  if (!map) throw IoError::malformed(tile_path(city.folder, tile), "is gone: the city was changed while it was read");
  VoxelMap part{map->frame, {}, map->has_color, map->label_scheme};
  part.levels.push_back(cut_leaves(map->finest(), box));
  return part;
}

VoxelLevel load_window_of(const City& city, const openvdb::CoordBBox& box) {
  const std::int32_t per_tile = voxels_per_tile(city.manifest.layout.voxel_sizes.front());
  std::vector<const CityTile*> tiles;
  for (const CityTile& tile : city.manifest.tiles) {
    if (reaches_into(tile.id, box, per_tile)) tiles.push_back(&tile);
  }
  std::vector<VoxelMap> parts(tiles.size());
  parallel_tasks(tiles.size(), [&](std::size_t i) { parts[i] = load_part(city, *tiles[i], box); });
  std::erase_if(parts, [](const VoxelMap& part) { return part.finest().size() == 0; });
  if (parts.empty()) return {city.manifest.layout.voxel_sizes.front(), {}, {}};
  VoxelMap whole = parts.size() == 1 ? std::move(parts.front()) : splice(parts);
  return std::move(whole.levels.front());
}

}  // namespace

SiteSource::SiteSource(const std::filesystem::path& path) : path_(path) {
  if (is_city(path)) {
    take(open_city(path));
  } else {
    take(load_map(path));
  }
  if (tiles_.empty()) throw IoError::malformed(path, "holds no voxels to show");
}

void SiteSource::take(VoxelMap map) {
  if (map.levels.empty()) return;
  map.levels.erase(map.levels.begin() + 1, map.levels.end());
  layout_ = layout_of(map, 0);
  tiles_ = tiles_of(map);
  const std::vector<std::int32_t>& epochs = map.finest().channels().last_epochs;
  if (!epochs.empty()) newest_epoch_ = *std::ranges::max_element(epochs);
  voxels_ = std::move(map);
}

void SiteSource::take(City city) {
  layout_ = city.manifest.layout;
  newest_epoch_ = city.manifest.epoch;
  for (const CityTile& tile : city.manifest.tiles) {
    if (tile.num_voxels.front() > 0) tiles_.push_back(tile.id);
  }
  voxels_ = std::move(city);
}

bool SiteSource::has_channel(const std::string& name) const {
  return std::ranges::find(layout_.channels, name) != layout_.channels.end();
}

VoxelLevel SiteSource::load(const openvdb::CoordBBox& box) const {
  const auto* city = std::get_if<City>(&voxels_);
  return city ? load_window_of(*city, box) : cut_leaves(std::get<VoxelMap>(voxels_).finest(), box);
}

}  // namespace vdbmap
