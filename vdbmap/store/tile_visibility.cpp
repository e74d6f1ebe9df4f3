// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/tile_visibility.h"

#include <algorithm>
#include <utility>

#include "vdbmap/change/voxel_fates.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/vdb/visibility_file.h"
#include "vdbmap/store/city_window.h"

namespace vdbmap {
namespace {

// The counts of those leaves that both levels have, to their places in the other.
std::vector<std::uint32_t> counts_at(const std::vector<std::uint32_t>& counts, const VoxelLevel& from,
                                     const VoxelLevel& to) {
  std::vector<std::uint32_t> result(to.size());
  for (const VoxelLeaf& leaf : to.leaves()) {
    const VoxelLeaf* source = from.tree().find_leaf(leaf.origin());
    if (!source) continue;
    std::copy_n(counts.begin() + static_cast<std::ptrdiff_t>(source->transientData()), leaf.getValueMask().countOn(),
                result.begin() + static_cast<std::ptrdiff_t>(leaf.transientData()));
  }
  return result;
}

// The counts of voxels that both levels have.
std::vector<std::uint32_t> counts_of_voxels(const std::vector<std::uint32_t>& counts, const VoxelLevel& from,
                                            const VoxelLevel& to) {
  std::vector<std::uint32_t> result(to.size());
  const VoxelFinder finder(from);
  for_each_voxel(to, [&](const VoxelIndex& voxel, std::size_t record) {
    const VoxelRecord* source = finder.find(voxel);
    if (source) result[record] = counts[static_cast<std::size_t>(source - from.records().data())];
  });
  return result;
}

}  // namespace

std::vector<TileId> tiles_of(const VoxelTree& tree, double voxel_size) {
  const std::int32_t per_tile = voxels_per_tile(voxel_size);
  std::vector<TileId> tiles;
  for (const VoxelLeaf& leaf : tree.leaves()) {
    const TileId tile = tile_of_leaf(leaf, per_tile);
    if (tiles.empty() || tile != tiles.back()) tiles.push_back(tile);
  }
  std::ranges::sort(tiles);
  tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
  return tiles;
}

Visibility cut_visibility(const Visibility& visibility, const VoxelLevel& level, const TileId& id,
                          const VoxelLevel& tile) {
  const std::int32_t per_tile = voxels_per_tile(level.voxel_size());
  LargeVector<VoxelLeaf> leaves;
  for (const VoxelLeaf& leaf : visibility.seen_empty.leaves()) {
    if (tile_of_leaf(leaf, per_tile) == id) leaves.push_back(leaf);
  }
  return {visibility.voxel_size, VoxelTree(std::move(leaves)), counts_at(visibility.hits, level, tile),
          counts_at(visibility.passes, level, tile)};
}

Visibility spread_visibility(const Visibility& visibility, const VoxelLevel& tile, const VoxelLevel& level) {
  return {visibility.voxel_size, visibility.seen_empty, counts_at(visibility.hits, tile, level),
          counts_at(visibility.passes, tile, level)};
}

std::optional<Visibility> load_tile_visibility(const City& city, const CityTile& tile, const VoxelMap& map) {
  if (!tile.has_rays) return std::nullopt;
  const std::filesystem::path path = tile_path(city.folder, tile);
  std::optional<Visibility> visibility = load_visibility(path, map);
  if (!visibility) throw IoError::malformed(path, "does not say what rays saw, as the manifest promises");
  return visibility;
}

std::optional<Visibility> carry_visibility(const std::optional<City>& before, const TileId& id, const VoxelMap& after) {
  const CityTile* tile = before ? find_tile(before->manifest, id) : nullptr;
  if (!tile || !tile->has_rays) return std::nullopt;
  const VoxelMap map = load_present_tile(*before, *tile);
  const std::optional<Visibility> known = load_tile_visibility(*before, *tile, map);
  const VoxelLevel& level = after.finest();
  return Visibility{level.voxel_size(), united(known->seen_empty, VoxelTree{{}}, level.tree()),
                    counts_of_voxels(known->hits, map.finest(), level),
                    counts_of_voxels(known->passes, map.finest(), level)};
}

}  // namespace vdbmap
