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

/// The tile of a point [m, local frame].
inline TileId tile_of_point(const Eigen::Vector3d& point) {
  return {static_cast<std::int32_t>(std::floor(point.x() / kTileSize)),
          static_cast<std::int32_t>(std::floor(point.y() / kTileSize))};
}

/// Edge of a tile in voxels, a multiple of 8. Throws as voxels_per_metre() does.
inline std::int32_t voxels_per_tile(double voxel_size) {
  return static_cast<std::int32_t>(std::lround(voxels_per_metre(voxel_size) * kTileSize));
}

}  // namespace vdbmap
