// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "vdbmap/core/finest_level.h"
#include "vdbmap/store/city_folder.h"

namespace vdbmap {

/// Tiles of a city and those around them, as far as there are any. Kept while they are needed.
class TileNeighborhood {
 public:
  /// Of no city: there are no tiles.
  explicit TileNeighborhood(const std::optional<City>& city) : city_(city) {}

  /// Loads what lies in and around these tiles and is not loaded yet, forgets the rest. Throws IoError, also for a tile
  /// that is missing.
  void load_around(std::span<const TileId> tiles);

  /// A tile that is loaded, or nullptr.
  const VoxelMap* tile(const TileId& tile) const;

  /// The voxels of a tile and of the margin [m] around it, those of load_around(); nothing where it has none.
  std::optional<VoxelMap> window(const TileId& tile, double margin) const;

 private:
  const std::optional<City>& city_;
  std::map<TileId, VoxelMap> loaded_;
};

/// The layout of a city with the points of another in it, as merge_maps() decides. Throws std::invalid_argument where
/// they do not go together.
CityLayout merged_layout(const CityLayout& city, const CityLayout& added);

/// The map of the sums of a tile and its margin, with what the city had there; cut to the tile, in the layout given.
VoxelMap finish_tile(const TileId& tile, VoxelBlocks sums, const FinestLevelOptions& finest,
                     const std::optional<VoxelMap>& before, const CityLayout& added, const CityLayout& layout);

/// What the finest level of points of this layout is like; `epoch` is that of all of them.
FinestLevelOptions finest_options(const CityLayout& layout, std::optional<std::int32_t> epoch);

/// Sums of the points of one epoch.
struct EpochSums {
  std::int32_t epoch = 0;
  VoxelBlocks sums;
};

/// The map of all sums of a tile and its margin, cut to the tile. Where the layout has epochs, those of a voxel are the
/// first and the last whose sums have it. `epochs` rise.
VoxelMap finish_tile(const TileId& tile, std::vector<EpochSums> epochs, const CityLayout& layout);

/// A map with all attributes of a layout: where it lacks one, voxels get what merge_maps() gives them.
VoxelMap in_layout(VoxelMap map, const CityLayout& layout);

}  // namespace vdbmap
