// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/web/quad_tile.h"

#include <cmath>

#include "vdbmap/core/tile_id.h"

namespace vdbmap {
namespace {

constexpr double kBlockEdge = 4 * kTileSize;  // [m] at least: what is read again around a block stays a part of it

}  // namespace

std::string name_of(const QuadTile& tile) {
  return std::to_string(tile.level) + "_" + std::to_string(tile.x) + "_" + std::to_string(tile.y);
}

double SiteGrid::voxel_size(std::int32_t level) const { return std::ldexp(finest_voxel_size, level); }

SiteGrid site_grid(double finest_voxel_size) {
  constexpr std::int32_t kLeaf = 8;
  SiteGrid grid{finest_voxel_size, voxels_per_tile(finest_voxel_size), 0};
  while (grid.side > kByteSide && grid.side % (2 * kLeaf) == 0) grid.side /= 2;
  while (grid.edge(grid.block_level) < kBlockEdge * (1 - 1e-9)) ++grid.block_level;
  return grid;
}

}  // namespace vdbmap
