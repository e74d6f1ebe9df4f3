// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "vdbmap/web/site_folder.h"
#include "vdbmap/web/site_source.h"
#include "vdbmap/web/tileset.h"

namespace vdbmap {

/// The tiles of one epoch.
struct SiteTiles {
  TileFiles files;
  std::uint64_t num_voxels = 0;  ///< of the finest level
  std::uint64_t num_points = 0;  ///< counted in them
  std::bitset<256> label_codes;  ///< that occur
  openvdb::CoordBBox voxels;     ///< around those of the finest level
  std::int32_t num_levels = 0;
};

/// What became of the voxels of an epoch since the one before.
struct SiteChanges {
  const VoxelLevel* marks = nullptr;   ///< of a diff, see change_marks(); nullptr: nothing is known
  const SiteSource* before = nullptr;  ///< what vanished looks as it did there
};

/// Number of blocks that a source is worked through in: squares of 256 m, mostly.
std::size_t num_blocks(const SiteSource& source);

/// Writes the tiles of all levels, `tiles/` and `details/` of the site. Levels end with the one that needs a single
/// tile, or the four around the origin.
///
/// Each block is loaded with what its outermost voxels of all levels have beside them, so its tiles are those of the
/// whole. Memory is that of one block, and the voxels of the block level: some 1/200 of the finest. The same files for
/// any number of threads.
SiteTiles write_tiles(
    const SiteSource& source, const SiteChanges& changes, SiteFolder& folder,
    const std::function<void()>& on_block_done = [] {});

}  // namespace vdbmap
