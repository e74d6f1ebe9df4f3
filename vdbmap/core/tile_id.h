// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <compare>
#include <cstdint>

#include "vdbmap/core/voxel.h"

namespace vdbmap {

/// A column of kTileSize x kTileSize, from x to x + 1 and y to y + 1 tiles of the local frame. Its borders are borders
/// of leaves at every voxel size, so a leaf lies in one tile.
struct TileId {
  std::int32_t x = 0;
  std::int32_t y = 0;

  auto operator<=>(const TileId&) const = default;
};

/// The tile of a voxel; `voxels_per_tile` is that of its level.
inline TileId tile_of_voxel(const VoxelIndex& voxel, std::int32_t voxels_per_tile) {
  return {floor_divide(voxel.x(), voxels_per_tile), floor_divide(voxel.y(), voxels_per_tile)};
}

/// The tile of a point [m, local frame]. The caller has checked is_addressable().
inline TileId tile_of_point(const Eigen::Vector3d& point) {
  return {static_cast<std::int32_t>(std::floor(point.x() / kTileSize)),
          static_cast<std::int32_t>(std::floor(point.y() / kTileSize))};
}

/// Edge of a tile in voxels, a multiple of 8. Throws as voxels_per_metre() does.
inline std::int32_t voxels_per_tile(double voxel_size) {
  return static_cast<std::int32_t>(std::lround(voxels_per_metre(voxel_size) * kTileSize));
}

/// Tiles from `low` to `high` on both axes, both included.
struct TileRange {
  TileId low;
  TileId high;
};

/// A margin [m] around a tile in voxels of a level, in whole leaves.
inline std::int32_t margin_in_voxels(double margin, double voxel_size) {
  constexpr std::int32_t kLeaf = 8;
  constexpr double kTolerance = 1e-9;  // 0.8 m are one leaf at 10 cm, not two
  return kLeaf * static_cast<std::int32_t>(std::ceil(margin * voxels_per_metre(voxel_size) / kLeaf - kTolerance));
}

/// The tiles that a cube of whole leaves reaches into, or comes within `margin` voxels of, a whole number of leaves.
/// `origin` is the cube's lowest voxel, `edge` its length in voxels.
inline TileRange tiles_around(const VoxelIndex& origin, std::int32_t edge, std::int32_t margin,
                              std::int32_t voxels_per_tile) {
  return {tile_of_voxel(origin.offsetBy(-margin), voxels_per_tile),
          tile_of_voxel(origin.offsetBy(edge - 1 + margin), voxels_per_tile)};
}

/// Whether a tile is one of a range.
inline bool contains(const TileRange& range, const TileId& tile) {
  return range.low.x <= tile.x && tile.x <= range.high.x && range.low.y <= tile.y && tile.y <= range.high.y;
}

}  // namespace vdbmap
