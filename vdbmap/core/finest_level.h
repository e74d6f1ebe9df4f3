// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "vdbmap/core/label_votes.h"
#include "vdbmap/core/sorted_points.h"
#include "vdbmap/core/voxel_block.h"
#include "vdbmap/core/voxel_level.h"

namespace vdbmap {

/// What is known of the voxels of a block.
struct BlockContent {
  BlockSums sums;
  std::vector<LabelVotes> votes;  ///< sorted
};

/// Adds sums and votes to those of a block.
void add_content(BlockContent& content, BlockContent added);

using VoxelBlocks = std::map<BlockKey, BlockContent>;

/// Adds the sums and votes of the points to their blocks.
void add_points(VoxelBlocks& blocks, const SortedPoints& points);

/// What the finest level is like, beside its voxels.
struct FinestLevelOptions {
  double voxel_size = 0;  ///< [m]
  bool has_intensity = false;
  bool has_labels = false;
  std::optional<std::int32_t> epoch;  ///< first and last epoch of every voxel
};

/// The level of all blocks, without normals. The last points, if any, are added on the way: where nothing else is in a
/// block of theirs, its records are made straight from them, and no sums (136 bytes a voxel) are stored.
VoxelLevel make_finest_level(VoxelBlocks blocks, const SortedPoints* last_points, const FinestLevelOptions& options);

}  // namespace vdbmap
