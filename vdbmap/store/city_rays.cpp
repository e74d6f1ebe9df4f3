// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/city_rays.h"

#include <algorithm>
#include <set>
#include <utility>

#include "vdbmap/change/voxel_fates.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/core/parallel_tasks.h"
#include "vdbmap/store/city_window.h"
#include "vdbmap/store/ray_windows.h"
#include "vdbmap/store/tile_finish.h"
#include "vdbmap/store/tile_visibility.h"

namespace vdbmap {
namespace {

VoxelMap map_without_voxels(const CityLayout& layout) {
  return in_layout(empty_map(layout.frame, layout.voxel_sizes), layout);
}

// Points of voxels that were not there before.
void add_hits(Visibility& visibility, const VoxelLevel& level, const std::optional<VoxelMap>& before) {
  const VoxelLevel nothing(level.voxel_size(), {}, {});
  const VoxelFinder known(before ? before->finest() : nothing);
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t record) {
    const VoxelRecord* old = known.find(voxel);
    visibility.hits[record] += level.records()[record].count - (old ? old->count : 0);
  });
}

void add_found(Visibility& visibility, const VoxelLevel& level, const TileFindings& found) {
  const std::vector<std::uint32_t>& passes = found.maps.front().passes;
  for (std::size_t i = 0; i < passes.size(); ++i) visibility.passes[i] += passes[i];
  visibility.seen_empty = united(visibility.seen_empty, found.seen_empty, level.tree());
}

CityTile tile_with_rays(const TileId& id, const City& made, const std::optional<City>& base, const RayWindows& rays,
                        const SaveTile& save) {
  const CityTile* tile = find_tile(made.manifest, id);
  const VoxelMap map = tile ? load_present_tile(made, *tile) : map_without_voxels(made.manifest.layout);
  const VoxelLevel& level = map.finest();
  const std::optional<Visibility> known = tile ? load_tile_visibility(made, *tile, map) : std::nullopt;
  Visibility visibility = known
                              ? *known
                              : Visibility{level.voxel_size(), VoxelTree{{}}, std::vector<std::uint32_t>(level.size()),
                                           std::vector<std::uint32_t>(level.size())};
  const CityTile* old = base ? find_tile(base->manifest, id) : nullptr;
  add_hits(visibility, level, old ? std::optional(load_present_tile(*base, *old)) : std::nullopt);
  if (const std::optional<TileFindings> found = rays.findings().read(id)) add_found(visibility, level, *found);
  return save(id, map, visibility);
}

}  // namespace

std::vector<CityTile> add_rays_to_tiles(const City& made, const std::optional<City>& base, const CloudSource& clouds,
                                        std::size_t memory_bytes, const std::filesystem::path& folder,
                                        const SaveTile& save) {
  RayWindows rays({&made}, RayTrust{}, memory_bytes, folder);
  clouds([&](const PosedCloud& posed) { rays.add(posed); });
  rays.finish();
  std::vector<CityTile> tiles;
  std::set<TileId> ids = rays.tiles();
  for (const CityTile& tile : made.manifest.tiles) {
    const CityTile* old = base ? find_tile(base->manifest, tile.id) : nullptr;
    const bool is_untouched = old && *old == tile && !ids.contains(tile.id);
    if (is_untouched) tiles.push_back(tile);
    if (!is_untouched) ids.insert(tile.id);
  }
  const std::vector<TileId> list(ids.begin(), ids.end());
  std::vector<CityTile> saved(list.size());
  parallel_tasks(list.size(), [&](std::size_t i) { saved[i] = tile_with_rays(list[i], made, base, rays, save); });
  tiles.insert(tiles.end(), saved.begin(), saved.end());
  std::ranges::sort(tiles, {}, &CityTile::id);
  return tiles;
}

}  // namespace vdbmap
