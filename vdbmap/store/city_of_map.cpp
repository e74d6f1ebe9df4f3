// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/city_of_map.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <tuple>

#include "vdbmap/core/error.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/store/city_writer.h"
#include "vdbmap/store/tile_visibility.h"

namespace vdbmap {
namespace {

std::int32_t latest_epoch(const VoxelMap& map) {
  const std::vector<std::int32_t>& epochs = map.finest().channels().last_epochs;
  return epochs.empty() ? 0 : std::max(0, *std::ranges::max_element(epochs));
}

}  // namespace

CityManifest save_city(const std::filesystem::path& folder, const VoxelMap& map, const SaveOptions& options,
                       const std::vector<MapSource>& sources) {
  return save_city(folder, map, {{}, {{}, sources}}, options);
}

CityManifest save_city(const std::filesystem::path& folder, const VoxelMap& map, const MapExtras& extras,
                       const SaveOptions& options) {
  CityWriter writer(folder);
  if (writer.current()) throw IoError::malformed(folder, "holds a city already");
  CityManifest manifest{
      latest_epoch(map), layout_of(map, options.density), {}, extras.history.sources, extras.history.epochs};
  std::ranges::sort(manifest.sources, {}, [](const MapSource& s) { return std::tie(s.epoch, s.name, s.hash); });
  const auto save = [&](const TileId& id, const VoxelMap& tile) {
    std::optional<Visibility> seen;
    if (extras.visibility) seen = cut_visibility(*extras.visibility, map.finest(), id, tile.finest());
    manifest.tiles.push_back(writer.save_tile(id, tile, options.density, seen));
  };
  for_each_tile(map, save);
  if (extras.visibility) {
    const std::vector<TileId> occupied = tiles_of(map);
    for (const TileId& id : tiles_of(extras.visibility->seen_empty, map.finest().voxel_size())) {
      if (!std::ranges::binary_search(occupied, id)) save(id, cut_tile(map, id));
    }
    std::ranges::sort(manifest.tiles, {}, &CityTile::id);
  }
  writer.publish(manifest, std::numeric_limits<std::size_t>::max());
  return manifest;
}

}  // namespace vdbmap
