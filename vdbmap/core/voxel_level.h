// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "vdbmap/core/large_allocator.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/core/voxel.h"
#include "vdbmap/core/voxel_record.h"
#include "vdbmap/core/voxel_tree.h"

namespace vdbmap {

/// Attributes that only some maps know: empty, or one value a voxel in the order of the records.
struct VoxelChannels {
  std::vector<float> intensities;          ///< mean intensity, scale of the source
  std::vector<std::int32_t> labels;        ///< class of most points that have one, else kNoLabel (label_scheme.h)
  std::vector<std::int32_t> first_epochs;  ///< epoch in which the voxel was first seen
  std::vector<std::int32_t> last_epochs;   ///< epoch in which the voxel was last seen
};

/// Calls body(name, member) for every channel; the name is that of its attribute and grid in files.
template <typename Body>
void for_each_channel(const Body& body) {
  body("intensity", &VoxelChannels::intensities);
  body("label", &VoxelChannels::labels);
  body("first_epoch", &VoxelChannels::first_epochs);
  body("last_epoch", &VoxelChannels::last_epochs);
}

/// One resolution of a map: occupied voxels and what is stored of each.
///
/// The tree holds only bit masks; records lie in one array in the tree's own order (leaf by leaf, within a leaf by
/// offset), and a leaf's transientData() is the number of its first record. Street leaves are a fifteenth full
/// (33 to 41 of 512 voxels in KITTI scans), so this costs some 50 bytes a voxel where a PointDataGrid, whose leaves
/// carry 512 offsets each, costs 130; a voxel alone in its leaf costs 137.
class VoxelLevel {
 public:
  /// Takes leaves in tree order with empty transientData, and the records of their active voxels in the same order.
  VoxelLevel(double voxel_size, LargeVector<VoxelLeaf> leaves, LargeVector<VoxelRecord> records,
             VoxelChannels channels = {});

  double voxel_size() const { return voxel_size_; }  ///< [m]
  std::size_t size() const { return records_.size(); }
  const VoxelTree& tree() const { return *tree_; }
  std::span<const VoxelRecord> records() const { return records_; }
  std::span<VoxelRecord> records() { return records_; }
  const VoxelChannels& channels() const { return channels_; }
  VoxelChannels& channels() { return channels_; }  ///< each stays empty or gets one value a record

  /// All leaves in tree order, which is the order of the records.
  std::span<const VoxelLeaf> leaves() const { return tree_->leaves(); }

  /// Tree, records and channels.
  std::size_t memory_bytes() const;

 private:
  double voxel_size_;
  std::shared_ptr<const VoxelTree> tree_;
  LargeVector<VoxelRecord> records_;
  VoxelChannels channels_;
};

/// Number of active voxels of the leaf before `offset`.
inline std::uint32_t rank_in_leaf(const VoxelLeaf& leaf, openvdb::Index offset) {
  const auto& mask = leaf.getValueMask();
  const openvdb::Index word = offset >> 6;
  int rank = std::popcount(mask.getWord<openvdb::Index64>(word) & ((std::uint64_t{1} << (offset & 63)) - 1));
  for (openvdb::Index i = 0; i < word; ++i) rank += std::popcount(mask.getWord<openvdb::Index64>(i));
  return static_cast<std::uint32_t>(rank);
}

/// Calls body(voxel, record_number) for every voxel of the leaf in the order of the records.
template <typename Body>
void for_each_voxel(const VoxelLeaf& leaf, const Body& body) {
  std::size_t record = leaf.transientData();
  for (auto it = leaf.getValueMask().beginOn(); it; ++it) body(leaf.offsetToGlobalCoord(it.pos()), record++);
}

/// Number of voxels of a leaf in its layer x, 0 to 7.
inline std::size_t count_in_layer(const VoxelLeaf& leaf, int x) {
  return static_cast<std::size_t>(
      std::popcount(leaf.getValueMask().getWord<openvdb::Index64>(static_cast<openvdb::Index>(x))));
}

/// The bits of each layer x of a leaf that lie from `low` to `high` on the axes y and z, both included and both in the
/// leaf: bit 8 y + z.
inline std::uint64_t box_in_layer(const VoxelIndex& low, const VoxelIndex& high) {
  const std::uint64_t row = ((2u << (high.z() & 7)) - 1) & ~((1u << (low.z() & 7)) - 1);
  const std::uint64_t rows = ~std::uint64_t{0} >> (56 - 8 * (high.y() & 7)) & ~std::uint64_t{0} << (8 * (low.y() & 7));
  return row * 0x0101010101010101u & rows;
}

/// Whether any voxel of the leaf is occupied from `low` to `high`, both included and both in the leaf.
inline bool has_voxel_in(const VoxelLeaf& leaf, const VoxelIndex& low, const VoxelIndex& high) {
  std::uint64_t bits = 0;
  for (int x = low.x() & 7; x <= (high.x() & 7); ++x) {
    bits |= leaf.getValueMask().getWord<openvdb::Index64>(static_cast<openvdb::Index>(x));
  }
  return (bits & box_in_layer(low, high)) != 0;
}

/// Calls body(voxel, record_number) for the voxels of the leaf from `low` to `high`, both included and both in the
/// leaf, in the order of the records.
template <typename Body>
void for_each_voxel_in(const VoxelLeaf& leaf, const VoxelIndex& low, const VoxelIndex& high, const Body& body) {
  const std::uint64_t box = box_in_layer(low, high);
  const int first_layer = low.x() & 7;
  std::size_t first_of_layer = leaf.transientData();
  for (int i = 0; i < first_layer; ++i) first_of_layer += count_in_layer(leaf, i);
  for (std::int32_t x = low.x(); x <= high.x(); ++x) {
    const auto layer = leaf.getValueMask().getWord<openvdb::Index64>(static_cast<openvdb::Index>(x & 7));
    for (std::uint64_t inside = layer & box; inside != 0; inside &= inside - 1) {
      const int bit = std::countr_zero(inside);
      const auto rank = static_cast<std::size_t>(std::popcount(layer & ((std::uint64_t{1} << bit) - 1)));
      body(VoxelIndex(x, (low.y() & ~7) | bit >> 3, (low.z() & ~7) | (bit & 7)), first_of_layer + rank);
    }
    first_of_layer += static_cast<std::size_t>(std::popcount(layer));
  }
}

/// Calls body(voxel, record_number) for every voxel of the level, one after the other in the order of the records.
template <typename Body>
void for_each_voxel(const VoxelLevel& level, const Body& body) {
  for (const VoxelLeaf& leaf : level.leaves()) for_each_voxel(leaf, body);
}

/// Calls body(voxel, record_number) for every voxel of the level, on all threads.
template <typename Body>
void parallel_for_each_voxel(const VoxelLevel& level, const Body& body) {
  const std::span<const VoxelLeaf> leaves = level.leaves();
  parallel_for(
      leaves.size(), [&](std::size_t i) { for_each_voxel(leaves[i], body); }, 64);
}

/// Finds the records of voxels; remembers the leaves it met last, so that neighbours cost little. One per task.
class VoxelFinder {
 public:
  explicit VoxelFinder(const VoxelLevel& level) : tree_(level.tree()), records_(level.records().data()) {}

  /// The record of an occupied voxel, else nullptr.
  const VoxelRecord* find(const VoxelIndex& voxel) const {
    const VoxelLeaf* leaf = find_leaf(voxel);
    if (!leaf) return nullptr;
    const openvdb::Index offset = VoxelLeaf::coordToOffset(voxel);
    if (!leaf->getValueMask().isOn(offset)) return nullptr;
    return records_ + leaf->transientData() + rank_in_leaf(*leaf, offset);
  }

  /// Calls body(voxel, record) for every occupied voxel whose index differs by at most `reach` on each axis.
  /// Leaf by leaf, and in a leaf whole rows of its bit mask at once: empty cells cost next to nothing.
  template <typename Body>
  void for_each_around(const VoxelIndex& center, std::int32_t reach, const Body& body) const {
    const VoxelIndex low = center.offsetBy(-reach);
    const VoxelIndex high = center.offsetBy(reach);
    for (std::int32_t x = low.x(); x <= high.x(); x = (x | 7) + 1) {
      for (std::int32_t y = low.y(); y <= high.y(); y = (y | 7) + 1) {
        for (std::int32_t z = low.z(); z <= high.z(); z = (z | 7) + 1) {
          const VoxelIndex first(x, y, z);
          const VoxelLeaf* leaf = find_leaf(first);
          if (!leaf) continue;
          for_each_voxel_in(*leaf, first, VoxelIndex::minComponent(high, {x | 7, y | 7, z | 7}),
                            [&](const VoxelIndex& voxel, std::size_t number) { body(voxel, records_[number]); });
        }
      }
    }
  }

 private:
  struct MetLeaf {
    VoxelIndex origin{std::numeric_limits<std::int32_t>::max()};  ///< of no leaf
    const VoxelLeaf* leaf = nullptr;
  };

  // What is around a voxel lies in a cube of 2 x 2 x 2 leaves, and each of them has a place of its own.
  const VoxelLeaf* find_leaf(const VoxelIndex& voxel) const {
    const VoxelIndex origin = VoxelTree::origin_of_leaf(voxel);
    MetLeaf& met = met_[VoxelTree::place_in_cube(voxel)];
    if (met.origin != origin) met = {origin, tree_.find_leaf(voxel)};
    return met.leaf;
  }

  const VoxelTree& tree_;
  const VoxelRecord* records_;
  mutable std::array<MetLeaf, 8> met_;
};

}  // namespace vdbmap
