// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/seen_window.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "vdbmap/core/error.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/core/voxel_block.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/io/vdb/visibility_file.h"

namespace vdbmap {
namespace {

VoxelTree join_trees(const std::vector<const VoxelTree*>& trees) {
  LargeVector<VoxelLeaf> leaves;
  for (const VoxelTree* tree : trees) leaves.insert(leaves.end(), tree->leaves().begin(), tree->leaves().end());
  std::ranges::sort(leaves, {}, [](const VoxelLeaf& leaf) { return key_of_voxel(leaf.origin()); });
  return VoxelTree(std::move(leaves));
}

// Counts of a tile's records to the places of these records in the window.
void place_counts(const VoxelLevel& tile, const VoxelLevel& window, const std::vector<std::uint32_t>& from,
                  std::vector<std::uint32_t>& to) {
  for (const VoxelLeaf& leaf : tile.leaves()) {
    const VoxelLeaf* placed = window.tree().find_leaf(leaf.origin());
    std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(leaf.transientData()), leaf.getValueMask().countOn(),
                to.begin() + static_cast<std::ptrdiff_t>(placed->transientData()));
  }
}

Visibility join_visibilities(const std::vector<LoadedMap>& tiles, const VoxelLevel& window) {
  Visibility joined;
  joined.voxel_size = window.voxel_size();
  joined.hits.resize(window.size());
  joined.passes.resize(window.size());
  std::vector<const VoxelTree*> trees;
  for (const LoadedMap& tile : tiles) {
    if (!tile.visibility) continue;
    trees.push_back(&tile.visibility->seen_empty);
    place_counts(tile.map.finest(), window, tile.visibility->hits, joined.hits);
    place_counts(tile.map.finest(), window, tile.visibility->passes, joined.passes);
  }
  joined.seen_empty = join_trees(trees);
  return joined;
}

}  // namespace

LoadedMap load_seen_map(const std::filesystem::path& path) {
  LoadedMap loaded{load_map(path), {}};
  loaded.visibility = load_visibility(path, loaded.map);
  return loaded;
}

LoadedMap load_seen_window(City& city, const TileChoice& is_wanted) {
  const CityManifest before = city.manifest;
  LoadedMap window{load_window(city, is_wanted), {}};
  if (city.manifest != before) throw IoError::malformed(city.folder, "was changed while it was read");
  std::vector<LoadedMap> tiles;
  for (const CityTile& tile : city.manifest.tiles) {
    if (is_wanted(tile) && tile.has_rays) {
      tiles.push_back(load_seen_map(tile_path(city.folder, tile)));
    }
  }
  if (!tiles.empty()) window.visibility = join_visibilities(tiles, window.map.finest());
  return window;
}

LoadedMap load_seen_map_or_city(const std::filesystem::path& path) {
  if (!is_city(path)) return load_seen_map(path);
  City city = open_city(path);
  return load_seen_window(city, [](const CityTile&) { return true; });
}

}  // namespace vdbmap
