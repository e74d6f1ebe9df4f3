// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "vdbmap/core/voxel_tree.h"

namespace vdbmap {

/// 8^3 voxels that rays may pass, and what is known of them so far.
struct alignas(64) SeenLeaf {
  static constexpr std::size_t kNumWords = 8;  ///< layers of x: bit 8 y + z of a layer
  static constexpr std::size_t kMostLevels = 2;

  // What every ray asks first lies in one line of a cache.
  openvdb::CoordBBox occupied_box;                     ///< around the occupied voxels
  std::atomic<bool> is_full{false};                    ///< all voxels are seen or occupied: nothing more to mark
  std::array<const VoxelLeaf*, kMostLevels> levels{};  ///< with voxels here

  std::array<std::atomic<std::uint64_t>, kNumWords> seen{};  ///< voxels that rays passed
  std::array<std::uint64_t, kNumWords> occupied{};           ///< voxels of any level

  bool has_occupied() const { return !occupied_box.empty(); }

  bool is_occupied(openvdb::Index offset) const { return (occupied[offset >> 6] >> (offset & 63) & 1) != 0; }

  void add_level(const VoxelLeaf& leaf, std::size_t level);

  void mark(openvdb::Index offset) {
    const std::uint64_t bit = std::uint64_t{1} << (offset & 63);
    std::atomic<std::uint64_t>& word = seen[offset >> 6];
    // Most voxels are seen many times; a look costs much less than a write that other threads must see.
    if ((word.load(std::memory_order_relaxed) & bit) == 0) word.fetch_or(bit, std::memory_order_relaxed);
  }

  bool has_all_marked() const;
};

/// A cube of 16^3 leaves; each is made when a ray enters it first.
class SeenBlock {
 public:
  static constexpr int kLog2Dim = 4;                                 ///< leaves a side
  static constexpr int kLog2Voxels = kLog2Dim + VoxelLeaf::LOG2DIM;  ///< voxels a side

  explicit SeenBlock(const VoxelIndex& origin) : origin_(origin) {}
  ~SeenBlock();
  SeenBlock(const SeenBlock&) = delete;
  SeenBlock& operator=(const SeenBlock&) = delete;

  const VoxelIndex& origin() const { return origin_; }

  /// The leaf of a cell, as CellWalk<4, 3> counts them. For any number of threads.
  SeenLeaf& leaf(openvdb::Index cell) {
    SeenLeaf* leaf = leaves_[cell].load(std::memory_order_acquire);
    return leaf ? *leaf : make_leaf(cell);
  }

  /// The leaf, or nullptr where no ray was.
  const SeenLeaf* find_leaf(openvdb::Index cell) const { return leaves_[cell].load(std::memory_order_acquire); }

  VoxelIndex origin_of_leaf(openvdb::Index cell) const {
    const auto axis = [&](int shift) { return static_cast<std::int32_t>(cell >> shift & 15) << VoxelLeaf::LOG2DIM; };
    return origin_ + VoxelIndex(axis(8), axis(4), axis(0));
  }

  static openvdb::Index cell_of_voxel(const VoxelIndex& voxel) {
    const auto axis = [](std::int32_t i) { return static_cast<openvdb::Index>(i >> VoxelLeaf::LOG2DIM & 15); };
    return axis(voxel.x()) << 8 | axis(voxel.y()) << 4 | axis(voxel.z());
  }

  static constexpr openvdb::Index kNumLeaves = 1 << 3 * kLog2Dim;

 private:
  SeenLeaf& make_leaf(openvdb::Index cell);

  VoxelIndex origin_;
  std::array<std::atomic<SeenLeaf*>, kNumLeaves> leaves_{};
};

/// Space that rays pass, marked by any number of threads at once: what is marked does not depend on their number or
/// order. Blocks of 128 voxels a side are made where rays come, 32 kB each and 192 B a leaf.
class SeenSpace {
 public:
  /// The block that holds the voxel.
  SeenBlock& block(const VoxelIndex& voxel);

  /// Tells the leaves of a level apart from empty space; before the first ray. Of at most SeenLeaf::kMostLevels.
  void add_occupied(const VoxelTree& tree, std::size_t level);

  /// The voxels that were marked and that no level occupies, in tree order.
  VoxelTree seen_empty() const;

 private:
  struct Hash {
    std::size_t operator()(const VoxelIndex& origin) const { return origin.hash<20>(); }
  };

  std::mutex mutex_;
  std::unordered_map<VoxelIndex, std::unique_ptr<SeenBlock>, Hash> blocks_;
};

/// Remembers the block that was met last. One per task.
class SeenBlockFinder {
 public:
  explicit SeenBlockFinder(SeenSpace& space) : space_(space) {}

  SeenBlock& find(const VoxelIndex& origin) {
    Met& met = met_[place_of(origin)];
    if (!met.block || met.origin != origin) met = {origin, &space_.block(origin)};
    return *met.block;
  }

 private:
  struct Met {
    VoxelIndex origin;
    SeenBlock* block = nullptr;
  };

  // Blocks around a scanner have places of their own.
  static std::size_t place_of(const VoxelIndex& origin) {
    const auto part = [](std::int32_t i) { return static_cast<std::size_t>(i >> SeenBlock::kLog2Voxels & 7); };
    return part(origin.x()) << 6 | part(origin.y()) << 3 | part(origin.z());
  }

  SeenSpace& space_;
  std::array<Met, 512> met_;
};

}  // namespace vdbmap
