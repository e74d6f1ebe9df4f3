// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/change/seen_space.h"

#include <algorithm>
#include <vector>

#include "vdbmap/core/parallel.h"
#include "vdbmap/core/voxel_block.h"

namespace vdbmap {
namespace {

// The leaf of what was seen and is not occupied.
VoxelLeaf empty_leaf(const SeenLeaf& leaf, const VoxelIndex& origin) {
  VoxelLeaf::NodeMaskType mask;
  for (std::size_t x = 0; x < SeenLeaf::kNumWords; ++x) {
    mask.getWord<openvdb::Index64>(static_cast<openvdb::Index>(x)) = leaf.seen[x].load() & ~leaf.occupied[x];
  }
  VoxelLeaf made(origin, false, false);
  made.setValueMask(mask);
  return made;
}

}  // namespace

void SeenLeaf::add_level(const VoxelLeaf& leaf, std::size_t level) {
  levels.at(level) = &leaf;
  for (std::size_t x = 0; x < kNumWords; ++x) {
    occupied[x] |= leaf.getValueMask().getWord<openvdb::Index64>(static_cast<openvdb::Index>(x));
  }
  for (auto voxel = leaf.getValueMask().beginOn(); voxel; ++voxel) {
    occupied_box.expand(leaf.offsetToGlobalCoord(voxel.pos()));
  }
}

bool SeenLeaf::has_all_marked() const {
  for (std::size_t x = 0; x < kNumWords; ++x) {
    if ((seen[x].load(std::memory_order_relaxed) | occupied[x]) != ~std::uint64_t{0}) return false;
  }
  return true;
}

SeenBlock::~SeenBlock() {
  for (const std::atomic<SeenLeaf*>& leaf : leaves_) delete leaf.load();
}

SeenLeaf& SeenBlock::make_leaf(openvdb::Index cell) {
  auto made = std::make_unique<SeenLeaf>();
  SeenLeaf* there = nullptr;
  if (!leaves_[cell].compare_exchange_strong(there, made.get(), std::memory_order_acq_rel)) return *there;
  return *made.release();
}

SeenBlock& SeenSpace::block(const VoxelIndex& voxel) {
  constexpr std::int32_t kMask = ~((1 << SeenBlock::kLog2Voxels) - 1);
  const VoxelIndex origin(voxel.x() & kMask, voxel.y() & kMask, voxel.z() & kMask);
  const std::lock_guard lock(mutex_);
  std::unique_ptr<SeenBlock>& block = blocks_[origin];
  if (!block) block = std::make_unique<SeenBlock>(origin);
  return *block;
}

void SeenSpace::add_occupied(const VoxelTree& tree, std::size_t level) {
  for (const VoxelLeaf& leaf : tree.leaves()) {
    block(leaf.origin()).leaf(SeenBlock::cell_of_voxel(leaf.origin())).add_level(leaf, level);
  }
}

VoxelTree SeenSpace::seen_empty() const {
  std::vector<const SeenBlock*> blocks;
  for (const auto& [origin, block] : blocks_) blocks.push_back(block.get());
  std::ranges::sort(blocks, {}, [](const SeenBlock* block) { return block_of_voxel(block->origin()); });
  std::vector<std::vector<VoxelLeaf>> parts(blocks.size());
  parallel_for(blocks.size(), [&](std::size_t i) {
    for (openvdb::Index cell = 0; cell < SeenBlock::kNumLeaves; ++cell) {
      const SeenLeaf* leaf = blocks[i]->find_leaf(cell);
      if (!leaf) continue;
      VoxelLeaf empty = empty_leaf(*leaf, blocks[i]->origin_of_leaf(cell));
      if (!empty.getValueMask().isOff()) parts[i].push_back(std::move(empty));
    }
  });
  LargeVector<VoxelLeaf> leaves;
  for (const std::vector<VoxelLeaf>& part : parts) leaves.insert(leaves.end(), part.begin(), part.end());
  return VoxelTree(std::move(leaves));
}

}  // namespace vdbmap
