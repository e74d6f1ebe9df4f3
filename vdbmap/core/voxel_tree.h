// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <openvdb/tree/LeafNodeMask.h>

#include "vdbmap/core/large_allocator.h"
#include "vdbmap/core/voxel.h"

namespace vdbmap {

/// 8^3 voxels as a bit mask. In a level, transientData() is the number of its first record.
using VoxelLeaf = openvdb::tree::LeafNode<openvdb::ValueMask, 3>;

/// Which voxels are occupied: leaves in one array, in the order in which OpenVDB walks its standard tree, and a hash
/// table that finds them.
///
/// OpenVDB's tree has a table of 4096 children for every cube of 128 voxels: 34 kB even where a single point lies in
/// it, as in airborne clouds. Here a leaf costs 80 bytes and its place in the table 13, whatever is around it.
class VoxelTree {
 public:
  /// Takes leaves in tree order (sorted by key_of_voxel() of their origins), each once and none empty.
  explicit VoxelTree(LargeVector<VoxelLeaf> leaves);

  /// All leaves in tree order.
  std::span<const VoxelLeaf> leaves() const { return leaves_; }

  /// The leaf that covers `voxel`, or nullptr where none of its voxels is occupied.
  const VoxelLeaf* find_leaf(const VoxelIndex& voxel) const {
    const Place place = place_of(voxel);
    for (std::size_t slot = place.slot; slots_[slot].leaf != kNone; slot = slot + 1 < slots_.size() ? slot + 1 : 0) {
      if (slots_[slot].tag != place.tag) continue;
      const VoxelLeaf& leaf = leaves_[slots_[slot].leaf];
      if (leaf.origin() == origin_of_leaf(voxel)) return &leaf;
    }
    return nullptr;
  }

  /// The box around all occupied voxels; empty without one.
  openvdb::CoordBBox voxel_box() const;

  /// Number of occupied voxels; counts them.
  std::size_t num_voxels() const;

  std::size_t memory_bytes() const { return leaves_.capacity() * sizeof(VoxelLeaf) + slots_.capacity() * sizeof(Slot); }

  /// Lowest voxel of the leaf that covers `voxel`.
  static VoxelIndex origin_of_leaf(const VoxelIndex& voxel) {
    return {voxel.x() & ~kLeafMask, voxel.y() & ~kLeafMask, voxel.z() & ~kLeafMask};
  }

  /// Number, 0 to 7, of a leaf among those of its cube of 2 x 2 x 2.
  static std::uint32_t place_in_cube(const VoxelIndex& voxel) {
    const auto bit = [](std::int32_t i) { return static_cast<std::uint32_t>(i) >> VoxelLeaf::LOG2DIM & 1; };
    return bit(voxel.x()) << 2 | bit(voxel.y()) << 1 | bit(voxel.z());
  }

 private:
  static constexpr std::int32_t kLeafMask = VoxelLeaf::DIM - 1;
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  static constexpr std::size_t kCubeSize = 8;  // leaves of a cube: their slots are one line of a cache

  struct Slot {
    std::uint32_t leaf = kNone;  ///< its number
    std::uint32_t tag = 0;       ///< of the leaf: tells most others apart without a look at them
  };

  struct Place {
    std::size_t slot;
    std::uint32_t tag;
  };

  // Leaves of one cube of 2 x 2 x 2 begin their search in one line, each in a slot of its own.
  Place place_of(const VoxelIndex& voxel) const {
    const auto part = [](std::int32_t i, std::uint64_t factor) {
      return static_cast<std::uint64_t>(i >> (VoxelLeaf::LOG2DIM + 1)) * factor;
    };
    std::uint64_t hash =
        part(voxel.x(), 0x9e3779b97f4a7c15) + part(voxel.y(), 0xc2b2ae3d27d4eb4f) + part(voxel.z(), 0x165667b19e3779f9);
    hash = (hash ^ hash >> 32) * 0xd6e8feb86659fd93;
    hash ^= hash >> 32;
    const auto low = static_cast<std::uint32_t>(hash);
    const std::uint32_t in_cube = place_in_cube(voxel);
    const std::size_t line = (hash >> 32) * (slots_.size() / kCubeSize) >> 32;
    return {line * kCubeSize + ((in_cube ^ low) & 7), (low & ~7U) | in_cube};
  }

  LargeVector<VoxelLeaf> leaves_;
  std::vector<Slot> slots_;
};

}  // namespace vdbmap
