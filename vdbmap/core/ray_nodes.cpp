// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/ray_nodes.h"

#include <algorithm>

namespace vdbmap {
namespace {

// Marks the cell that holds `voxel`, in the last node or in a new one. Voxels come in tree order.
template <typename Node>
void mark(std::vector<Node>& nodes, const VoxelIndex& voxel) {
  constexpr std::int32_t kSize = 1 << (Node::kLog2Dim + Node::kLog2Size);
  constexpr std::int32_t kMask = (1 << Node::kLog2Dim) - 1;
  const VoxelIndex origin(voxel.x() & -kSize, voxel.y() & -kSize, voxel.z() & -kSize);
  if (nodes.empty() || nodes.back().origin != origin) nodes.emplace_back().origin = origin;
  const auto place = [](std::int32_t i) { return static_cast<openvdb::Index>(i >> Node::kLog2Size & kMask); };
  const openvdb::Index cell =
      place(voxel.x()) << 2 * Node::kLog2Dim | place(voxel.y()) << Node::kLog2Dim | place(voxel.z());
  nodes.back().children.setOn(cell);
}

template <typename Node>
void number_children(std::vector<Node>& nodes) {
  std::uint32_t count = 0;
  for (Node& node : nodes) {
    for (openvdb::Index word = 0; word < Node::Mask::WORD_COUNT; ++word) {
      node.first_of_word[word] = count;
      count += static_cast<std::uint32_t>(std::popcount(node.children.template getWord<openvdb::Index64>(word)));
    }
  }
}

}  // namespace

RayNodes::RayNodes(const VoxelTree& tree) : leaves_(tree.leaves()) {
  for (const VoxelLeaf& leaf : leaves_) {
    box_.expand(leaf.getNodeBoundingBox());
    mark(blocks_, leaf.origin());
  }
  for (const Block& block : blocks_) mark(regions_, block.origin);
  number_children(blocks_);
  number_children(regions_);
}

const RayNodes::Region* RayNodes::find_region(const VoxelIndex& origin) const {
  const auto found = std::ranges::lower_bound(regions_, origin, {}, &Region::origin);
  return found != regions_.end() && found->origin == origin ? &*found : nullptr;
}

}  // namespace vdbmap
