// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "vdbmap/core/voxel.h"
#include "vdbmap/core/voxel_level.h"
#include "vdbmap/core/voxel_sums.h"

/// Blocks are cubes of 128 voxels, the lowest internal nodes of OpenVDB's standard tree. Keys sort blocks, and voxels
/// within a block, in the order in which OpenVDB walks that tree.
namespace vdbmap {

/// Sort key of a block, 42 bits.
enum class BlockKey : std::uint64_t {};

/// Sort key of a voxel within its block, 21 bits: leaf, then offset in the leaf.
using KeyInBlock = std::uint32_t;

/// Sort key of a voxel among those of all blocks.
enum class VoxelKey : std::uint64_t {};

inline constexpr int kBlockBits = 7;

/// Key of the block that holds an addressable voxel.
inline BlockKey block_of_voxel(const VoxelIndex& voxel) {
  // Root children span 4096 voxels, their children 128.
  const auto x = static_cast<std::uint64_t>((voxel.x() + kIndexLimit) >> kBlockBits);
  const auto y = static_cast<std::uint64_t>((voxel.y() + kIndexLimit) >> kBlockBits);
  const auto z = static_cast<std::uint64_t>((voxel.z() + kIndexLimit) >> kBlockBits);
  return BlockKey{(x >> 5) << 33 | (y >> 5) << 24 | (z >> 5) << 15 | (x & 31) << 10 | (y & 31) << 5 | (z & 31)};
}

/// Lowest voxel of a block.
inline VoxelIndex origin_of_block(BlockKey block) {
  const auto key = static_cast<std::uint64_t>(block);
  const auto axis = [&](int high, int low) {
    const auto cell = static_cast<std::int32_t>((key >> high & 511) << 5 | (key >> low & 31));
    return (cell << kBlockBits) - kIndexLimit;
  };
  return {axis(33, 10), axis(24, 5), axis(15, 0)};
}

/// Key of a voxel within its block.
inline KeyInBlock key_in_block(const VoxelIndex& voxel) {
  const auto x = static_cast<std::uint32_t>(voxel.x());
  const auto y = static_cast<std::uint32_t>(voxel.y());
  const auto z = static_cast<std::uint32_t>(voxel.z());
  const auto leaf = (x >> 3 & 15) << 8 | (y >> 3 & 15) << 4 | (z >> 3 & 15);
  return leaf << 9 | (x & 7) << 6 | (y & 7) << 3 | (z & 7);
}

/// Lowest voxel of the leaf that holds `key`, relative to the block.
inline VoxelIndex leaf_origin_in_block(KeyInBlock key) {
  const auto leaf = static_cast<std::int32_t>(key >> 9);
  return {(leaf >> 8 & 15) << 3, (leaf >> 4 & 15) << 3, (leaf & 15) << 3};
}

/// Offset of the voxel within its leaf.
inline openvdb::Index offset_in_leaf(KeyInBlock key) { return key & 511; }

/// Key of a voxel of a block.
inline VoxelKey key_of_voxel(BlockKey block, KeyInBlock key) {
  return VoxelKey{static_cast<std::uint64_t>(block) << (3 * kBlockBits) | key};
}

/// Key of an addressable voxel.
inline VoxelKey key_of_voxel(const VoxelIndex& voxel) {
  return key_of_voxel(block_of_voxel(voxel), key_in_block(voxel));
}

/// The voxel of a key.
inline VoxelIndex voxel_of_key(VoxelKey key) {
  const auto number = static_cast<std::uint64_t>(key);
  const auto in_block = static_cast<KeyInBlock>(number & ((std::uint64_t{1} << (3 * kBlockBits)) - 1));
  const auto offset = static_cast<std::int32_t>(offset_in_leaf(in_block));
  return origin_of_block(BlockKey{number >> (3 * kBlockBits)}) + leaf_origin_in_block(in_block) +
         VoxelIndex(offset >> 6, offset >> 3 & 7, offset & 7);
}

/// The sums of one voxel of a block.
struct KeyedSums {
  KeyInBlock key = 0;
  VoxelSums sums;
};

static_assert(sizeof(KeyedSums) == 136);

/// Occupied voxels of one block, sorted by key.
using BlockSums = std::vector<KeyedSums>;

/// Union of two blocks; voxels in both are added.
BlockSums merge_blocks(BlockSums a, BlockSums b);

/// Makes the leaves of a block of voxels that come in the order of their keys.
class BlockLeaves {
 public:
  explicit BlockLeaves(BlockKey block) : origin_(origin_of_block(block)) {}

  void add(KeyInBlock voxel);

  /// The leaves so far, in tree order.
  std::vector<VoxelLeaf> take() { return std::move(leaves_); }

 private:
  VoxelIndex origin_;
  KeyInBlock leaf_of_last_ = ~KeyInBlock{0};
  std::vector<VoxelLeaf> leaves_;
};

}  // namespace vdbmap
