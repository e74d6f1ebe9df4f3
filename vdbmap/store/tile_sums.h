// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <vector>

#include "vdbmap/core/finest_level.h"
#include "vdbmap/core/sorted_points.h"
#include "vdbmap/core/tile_id.h"

namespace vdbmap {

/// Sums of points, tile by tile, while a city is built. A tile has the sums of its own voxels and of those in the
/// margin around it (neighbor_margin() of map_tiles.h): it can be finished by itself, normals included, and voxels near
/// a border are kept two to four times.
///
/// Memory is bounded: where the sums of all tiles take more than `most_bytes`, those of the tiles that got no points
/// for longest are appended to files, a file a tile, until three quarters of that are left. Sums are whole numbers:
/// where they were in between changes no bit of the result.
class TileSums {
 public:
  /// `spill_folder` is there and empty.
  TileSums(const std::vector<double>& voxel_sizes, std::filesystem::path spill_folder, std::size_t most_bytes);

  /// Adds points. Throws IoError where the disk is full.
  void add(const SortedPoints& points);

  /// The tiles that have sums, in their margin at least, sorted.
  std::vector<TileId> tiles() const;

  /// All sums of a tile, which are gone here. Several threads may take different tiles at a time.
  VoxelBlocks take(const TileId& tile);

  /// How many bytes of sums went to files.
  std::uint64_t num_spilled_bytes() const { return num_spilled_bytes_; }

 private:
  struct Tile {
    VoxelBlocks blocks;
    std::size_t num_bytes = 0;  // of the blocks in memory
    std::uint64_t last_used = 0;
    bool has_file = false;
  };

  void spill_beyond_limit();
  std::filesystem::path file_of(const TileId& tile) const;

  std::int32_t voxels_per_tile_;
  std::int32_t margin_;  // [voxels]
  std::filesystem::path spill_folder_;
  std::size_t most_bytes_;
  std::map<TileId, Tile> tiles_;
  std::size_t num_bytes_ = 0;
  std::uint64_t num_adds_ = 0;
  std::uint64_t num_spilled_bytes_ = 0;
};

/// What of a block each tile gets: those leaves that lie in it or within `margin` voxels of it.
std::map<TileId, BlockContent> split_by_tile(BlockKey block, BlockContent content, std::int32_t margin,
                                             std::int32_t voxels_per_tile);

}  // namespace vdbmap
