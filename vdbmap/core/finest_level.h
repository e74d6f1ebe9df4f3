// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "vdbmap/core/sorted_points.h"
#include "vdbmap/core/voxel_block.h"
#include "vdbmap/core/voxel_level.h"

namespace vdbmap {

/// The sums of all voxels, block by block.
using VoxelBlocks = std::map<BlockKey, BlockSums>;

/// Adds points to the sums.
void add_points(VoxelBlocks& blocks, const SortedPoints& points);

/// What the finest level is like, beside its voxels.
struct FinestLevelOptions {
  double voxel_size = 0;  ///< [m]
  bool has_intensity = false;
  std::optional<std::int32_t> epoch;  ///< first and last epoch of every voxel
};

/// The level of the sums, without normals. The last points, if any, are added on the way: where nothing else is in a
/// block of theirs, its records are made straight from them, and no sums (144 bytes a voxel) are stored.
VoxelLevel make_finest_level(VoxelBlocks blocks, const SortedPoints* last_points, const FinestLevelOptions& options);

}  // namespace vdbmap
