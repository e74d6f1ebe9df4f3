// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "vdbmap/core/voxel_tree.h"

namespace vdbmap {

/// A cube of (2^kDim)^3 cells, each 2^kSize voxels a side. Cells that hold something are children, and their numbers
/// follow each other in the order of the cells.
template <int kDim, int kSize>
struct RayNode {
  static constexpr int kLog2Dim = kDim;
  static constexpr int kLog2Size = kSize;
  using Mask = openvdb::util::NodeMask<kDim>;

  VoxelIndex origin;  ///< lowest voxel
  Mask children;
  std::array<std::uint32_t, Mask::WORD_COUNT> first_of_word{};  ///< number of the first child in each word of the mask

  /// The number of the child in that cell.
  std::uint32_t child(openvdb::Index cell) const {
    const auto word = children.template getWord<openvdb::Index64>(cell >> 6);
    const std::uint64_t below = word & ((std::uint64_t{1} << (cell & 63)) - 1);
    return first_of_word[cell >> 6] + static_cast<std::uint32_t>(std::popcount(below));
  }
};

/// The leaves of a tree below cubes of 128 and of 4096 voxels, for rays that cross what is empty in large steps. Keeps
/// a reference to the leaves.
class RayNodes {
 public:
  using Block = RayNode<4, VoxelLeaf::LOG2DIM>;
  using Region = RayNode<5, Block::kLog2Dim + Block::kLog2Size>;

  explicit RayNodes(const VoxelTree& tree);

  /// The box around all leaves; empty without one.
  const openvdb::CoordBBox& box() const { return box_; }

  /// The region whose lowest voxel this is, or nullptr.
  const Region* find_region(const VoxelIndex& origin) const;

  const Block& child(const Region& region, openvdb::Index cell) const { return blocks_[region.child(cell)]; }
  const VoxelLeaf& child(const Block& block, openvdb::Index cell) const { return leaves_[block.child(cell)]; }

 private:
  std::span<const VoxelLeaf> leaves_;
  std::vector<Block> blocks_;
  std::vector<Region> regions_;  // sorted by origin
  openvdb::CoordBBox box_;
};

}  // namespace vdbmap
