// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "vdbmap/core/finest_level.h"
#include "vdbmap/core/visibility.h"
#include "vdbmap/store/city_folder.h"

namespace vdbmap {

/// Saves a tile, and what rays saw of it, somewhere and counts it. Several threads may do so at a time.
using SaveTile = std::function<CityTile(const TileId&, const VoxelMap&, const std::optional<Visibility>&)>;

/// What tiles are made anew of.
struct TileRenewal {
  const std::optional<City>& base;  ///< what is there already
  CityLayout added;                 ///< of the new points alone
  CityLayout layout;                ///< of all tiles afterwards
  std::optional<std::int32_t> epoch;
  std::function<VoxelBlocks(const TileId&)> take_sums;  ///< of a tile and its margin; called by any thread
  SaveTile save;
  std::function<void()> on_tile_done = [] {};  ///< called by any thread
};

/// The tiles with new points in or around them, finished and saved, in batches of one a thread; those without a voxel
/// are left out. In the order of `ids`. Throws IoError.
std::vector<CityTile> renew_tiles(std::span<const TileId> ids, const TileRenewal& renewal);

/// The tiles of a city that are not renewed, in the layout that it has now: saved anew where that is another. Throws
/// IoError.
std::vector<CityTile> keep_tiles(const City& base, std::vector<CityTile> tiles, const CityLayout& layout,
                                 const SaveTile& save);

}  // namespace vdbmap
