// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/segmentation/label_city.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "parking/segmentation/segment.h"
#include "vdbmap/core/error.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/store/city_window.h"
#include "vdbmap/store/city_writer.h"
#include "vdbmap/store/tile_visibility.h"

namespace vdbmap::parking {
namespace {

constexpr double kSeenAround = 24;  // [m] of what the network sees around a block: whole leaves of 0.1 m and of 1 m

using Blocks = std::map<TileId, std::vector<CityTile>>;

Blocks blocks_of(const CityManifest& manifest, std::int32_t side) {
  Blocks blocks;
  for (const CityTile& tile : manifest.tiles) {
    blocks[{floor_divide(tile.id.x, side), floor_divide(tile.id.y, side)}].push_back(tile);
  }
  return blocks;
}

// Whole leaves of a level that lie in a block of tiles or up to the margin around it.
VoxelLevel cut_block(const VoxelLevel& level, const TileId& block, std::int32_t side) {
  const std::int32_t per_tile = voxels_per_tile(level.voxel_size());
  const std::int32_t margin = margin_in_voxels(kSeenAround, level.voxel_size());
  openvdb::CoordBBox box = openvdb::CoordBBox::inf();
  box.min().x() = block.x * side * per_tile - margin;
  box.min().y() = block.y * side * per_tile - margin;
  box.max().x() = (block.x + 1) * side * per_tile - 1 + margin;
  box.max().y() = (block.y + 1) * side * per_tile - 1 + margin;
  return cut_leaves(level, box);
}

// A block of the city and what is around it, labelled.
VoxelMap labelled_block(City& city, const TileId& block, std::int32_t side, const NetworkWeights& network) {
  const CityManifest before = city.manifest;
  VoxelMap map = load_window(city, [&](const CityTile& tile) {
    const TileId low{block.x * side - 1, block.y * side - 1}, high{(block.x + 1) * side, (block.y + 1) * side};
    return contains({low, high}, tile.id);
  });
  if (city.manifest != before) throw IoError::malformed(city.folder, "was changed while it was read");
  for (VoxelLevel& level : map.levels) level = cut_block(level, block, side);
  label_map(map, network);
  return map;
}

// What rays saw stays as it was.
CityTile label_tile(const City& city, const CityTile& tile, const VoxelMap& labelled, const CityWriter& writer) {
  const VoxelMap part = cut_tile(labelled, tile.id);
  return writer.save_tile(tile.id, part, city.manifest.layout.density, load_tile_visibility(city, tile, part));
}

}  // namespace

CityManifest label_city(City& city, const std::filesystem::path& folder, const NetworkWeights& network,
                        const LabelCityOptions& options) {
  CityWriter writer(folder);
  if (writer.current()) throw IoError::malformed(folder, "holds a city already");
  CityManifest manifest = city.manifest;
  manifest.tiles.clear();
  const float density = manifest.layout.density;
  for (const auto& [block, tiles] : blocks_of(city.manifest, options.tiles_at_once)) {
    const VoxelMap map = labelled_block(city, block, options.tiles_at_once, network);
    if (map.finest().size() > 0) manifest.layout = layout_of(map, density);
    for (const CityTile& tile : tiles) {
      manifest.tiles.push_back(label_tile(city, tile, map, writer));
    }
    options.on_tiles_done(tiles.size());
  }
  std::ranges::sort(manifest.tiles, {}, &CityTile::id);
  writer.publish(manifest, std::numeric_limits<std::size_t>::max());
  return manifest;
}

}  // namespace vdbmap::parking
