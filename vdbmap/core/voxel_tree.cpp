// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel_tree.h"

#include <utility>

namespace vdbmap {
namespace {

// Slots a leaf: with five eighths of them taken, a search ends within a line of the cache.
constexpr double kSlotsPerLeaf = 1.6;

}  // namespace

VoxelTree::VoxelTree(LargeVector<VoxelLeaf> leaves) : leaves_(std::move(leaves)) {
  const auto wanted = static_cast<std::size_t>(static_cast<double>(leaves_.size()) * kSlotsPerLeaf);
  slots_.resize((wanted / kCubeSize + 1) * kCubeSize);
  for (std::size_t i = 0; i < leaves_.size(); ++i) {
    const Place place = place_of(leaves_[i].origin());
    std::size_t slot = place.slot;
    while (slots_[slot].leaf != kNone) slot = slot + 1 < slots_.size() ? slot + 1 : 0;
    slots_[slot] = {static_cast<std::uint32_t>(i), place.tag};
  }
}

std::size_t VoxelTree::num_voxels() const {
  std::size_t count = 0;
  for (const VoxelLeaf& leaf : leaves_) count += leaf.getValueMask().countOn();
  return count;
}

openvdb::CoordBBox VoxelTree::voxel_box() const {
  openvdb::CoordBBox box;
  for (const VoxelLeaf& leaf : leaves_) leaf.evalActiveBoundingBox(box, /*visitVoxels=*/true);
  return box;
}

}  // namespace vdbmap
