// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "vdbmap/core/tile_id.h"
#include "vdbmap/core/visibility.h"
#include "vdbmap/core/voxel_map.h"
#include "vdbmap/store/city_folder.h"

/// What rays saw, tile by tile: leaves lie in one tile, so this is a copy of memory.
namespace vdbmap {

/// The tile of a leaf; `voxels_per_tile` is that of its level.
inline TileId tile_of_leaf(const VoxelLeaf& leaf, std::int32_t voxels_per_tile) {
  return tile_of_voxel(leaf.origin(), voxels_per_tile);
}

/// The tiles in which a tree has leaves, sorted.
std::vector<TileId> tiles_of(const VoxelTree& tree, double voxel_size);

/// What lies in one tile of the visibility of `level`; `tile` is that level cut to it.
Visibility cut_visibility(const Visibility& visibility, const VoxelLevel& level, const TileId& id,
                          const VoxelLevel& tile);

/// The visibility of a tile as that of a level in which its leaves are, among others of which nothing is said.
Visibility spread_visibility(const Visibility& visibility, const VoxelLevel& tile, const VoxelLevel& level);

/// What a file of a city says of what rays saw of its tile, whose map is given; nothing where it says nothing. Throws
/// IoError.
std::optional<Visibility> load_tile_visibility(const City& city, const CityTile& tile, const VoxelMap& map);

/// The visibility of a tile once points were added of whose rays nothing is known: of voxels that were there it is what
/// it was. Nothing where nothing was known.
std::optional<Visibility> carry_visibility(const std::optional<City>& before, const TileId& id, const VoxelMap& after);

}  // namespace vdbmap
