// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/tile_renewal.h"

#include <algorithm>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/core/parallel_tasks.h"
#include "vdbmap/store/city_window.h"
#include "vdbmap/store/tile_finish.h"
#include "vdbmap/store/tile_visibility.h"

namespace vdbmap {

std::vector<CityTile> renew_tiles(std::span<const TileId> ids, const TileRenewal& renewal) {
  if (ids.empty()) return {};
  const FinestLevelOptions finest = finest_options(renewal.added, renewal.epoch);
  const double margin = neighbor_margin(renewal.layout.voxel_sizes);
  std::vector<std::optional<CityTile>> saved(ids.size());
  TileNeighborhood before(renewal.base);
  const std::size_t batch_size = num_threads();
  for (std::size_t begin = 0; begin < ids.size(); begin += batch_size) {
    const std::span batch = ids.subspan(begin, std::min(batch_size, ids.size() - begin));
    before.load_around(batch);
    parallel_tasks(batch.size(), [&](std::size_t i) {
      const TileId& id = batch[i];
      const VoxelMap tile =
          finish_tile(id, renewal.take_sums(id), finest, before.window(id, margin), renewal.added, renewal.layout);
      const std::optional<Visibility> seen = carry_visibility(renewal.base, id, tile);
      if (tile.finest().size() > 0 || seen) saved[begin + i] = renewal.save(id, tile, seen);
      renewal.on_tile_done();
    });
  }
  std::vector<CityTile> tiles;
  for (std::optional<CityTile>& tile : saved) {
    if (tile) tiles.push_back(std::move(*tile));
  }
  return tiles;
}

std::vector<CityTile> keep_tiles(const City& base, std::vector<CityTile> tiles, const CityLayout& layout,
                                 const SaveTile& save) {
  if (layout == base.manifest.layout) return tiles;
  parallel_tasks(tiles.size(), [&](std::size_t i) {
    VoxelMap map = load_present_tile(base, tiles[i]);
    const std::optional<Visibility> seen = load_tile_visibility(base, tiles[i], map);
    tiles[i] = save(tiles[i].id, in_layout(std::move(map), layout), seen);
  });
  return tiles;
}

}  // namespace vdbmap
