// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <compare>
#include <cstdint>
#include <string>

#include "vdbmap/core/voxel.h"

/// The quadtree of a site. Level 0 has the voxels of the map, each level above voxels twice as long. Tiles of all
/// levels have the same number of voxels on a side, so a tile has four children, two by two, in the level below.
namespace vdbmap {

/// A tile: columns from x side to (x + 1) side voxels of its level, the same in y, of any height.
struct QuadTile {
  std::int32_t level = 0;
  std::int32_t x = 0;
  std::int32_t y = 0;

  auto operator<=>(const QuadTile&) const = default;
};

/// The tile of the level above that holds `tile`.
inline QuadTile parent_of_tile(const QuadTile& tile) {
  return {tile.level + 1, floor_divide(tile.x, 2), floor_divide(tile.y, 2)};
}

/// "0_12_-3": level, x, y.
std::string name_of(const QuadTile& tile);

/// How a site is cut into tiles.
struct SiteGrid {
  double finest_voxel_size = 0;  ///< [m]
  std::int32_t side = 0;         ///< of a tile in voxels, a multiple of 8: a leaf lies in one tile at every level
  std::int32_t block_level = 0;  ///< whose tiles are computed at once: they are some tiles of a city long

  /// Voxel size of a level [m].
  double voxel_size(std::int32_t level) const;

  /// Edge of a tile of a level [m].
  double edge(std::int32_t level) const { return side * voxel_size(level); }
};

/// Longest side [voxels] of what an unsigned byte can address.
inline constexpr std::int32_t kByteSide = 256;

/// The grid of maps with these voxels. At 0.1 m tiles have 160 voxels on a side: 16 m, 32 m, 64 m and so on. Throws
/// std::invalid_argument as voxels_per_metre().
SiteGrid site_grid(double finest_voxel_size);

/// The tile of a voxel of a level.
inline QuadTile tile_of_voxel(const VoxelIndex& voxel, std::int32_t level, const SiteGrid& grid) {
  return {level, floor_divide(voxel.x(), grid.side), floor_divide(voxel.y(), grid.side)};
}

}  // namespace vdbmap
