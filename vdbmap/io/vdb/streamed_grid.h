// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <ostream>
#include <span>
#include <utility>
#include <vector>

#include <openvdb/io/Compression.h>

#include "vdbmap/core/parallel.h"
#include "vdbmap/core/voxel_level.h"
#include "vdbmap/io/vdb/standard_grids.h"

namespace vdbmap {

/// A grid over all voxels of a level that makes its tree while it is written, some blocks at a time: the file is that
/// of the whole tree, which would take 34 kB for every block of 128 voxels, however few of them are occupied. It can
/// only be written. Keeps a reference to the tree.
template <typename Grid>
class StreamedGrid final : public Grid {
 public:
  using Value = typename Grid::ValueType;
  using ValueOf = std::function<Value(std::size_t record)>;

  StreamedGrid(const VoxelLevel& level, ValueOf value_of)
      : StreamedGrid(level.tree(), level.size(), std::move(value_of)) {}

  /// Of voxels without a level; value_of() gets what their leaves' transientData() count from.
  StreamedGrid(const VoxelTree& tree, std::size_t num_voxels, ValueOf value_of)
      : Grid(openvdb::zeroVal<Value>()), tree_(tree), num_voxels_(num_voxels), value_of_(std::move(value_of)) {
    for (std::size_t i = 0; i < leaves().size(); ++i) {
      const VoxelIndex block = origin_of<Block>(leaves()[i].origin());
      if (!blocks_.empty() && blocks_.back().origin == block) continue;
      const VoxelIndex region = origin_of<Region>(block);
      if (regions_.empty() || regions_.back().origin != region) regions_.push_back({region, blocks_.size()});
      blocks_.push_back({block, i});
    }
  }

  openvdb::GridBase::Ptr copyGrid() override { return std::make_shared<StreamedGrid>(*this); }
  openvdb::GridBase::ConstPtr copyGrid() const override { return std::make_shared<const StreamedGrid>(*this); }
  openvdb::Index64 activeVoxelCount() const override { return num_voxels_; }
  openvdb::CoordBBox evalActiveVoxelBoundingBox() const override { return tree_.voxel_box(); }

  /// Of the whole tree, as a reader has it: what each kind of node costs is seen in trees of one or two leaves.
  openvdb::Index64 memUsage() const override {
    const openvdb::Index64 none = memory_of({});
    const openvdb::Index64 one = memory_of({VoxelIndex(0)});
    const openvdb::Index64 leaf = memory_of({VoxelIndex(0), VoxelIndex(VoxelLeaf::DIM)}) - one;
    const openvdb::Index64 block = memory_of({VoxelIndex(0), VoxelIndex(Block::DIM)}) - one - leaf;
    const openvdb::Index64 region = one - none - leaf - block;
    return none + leaves().size() * leaf + blocks_.size() * block + regions_.size() * region;
  }

  /// What Tree, RootNode and InternalNode write.
  void writeTopology(std::ostream& stream) const override {
    write_number(stream, std::int32_t{1});  // buffers
    stream.write(reinterpret_cast<const char*>(&background_), sizeof(background_));
    openvdb::io::setGridBackgroundValuePtr(stream, &background_);
    write_number(stream, openvdb::Index{0});  // tiles
    write_number(stream, static_cast<openvdb::Index>(regions_.size()));
    for (std::size_t i = 0; i < regions_.size(); ++i) {
      const std::size_t end = i + 1 < regions_.size() ? regions_[i + 1].first : blocks_.size();
      write_region(stream, regions_[i].origin, std::span(blocks_).subspan(regions_[i].first, end - regions_[i].first));
      for_each_block(regions_[i].first, end, /*with_values=*/false,
                     [&](const Block& block) { block.writeTopology(stream, this->saveFloatAsHalf()); });
    }
  }

  void writeBuffers(std::ostream& stream) const override {
    for_each_block(0, blocks_.size(), /*with_values=*/true,
                   [&](const Block& block) { block.writeBuffers(stream, this->saveFloatAsHalf()); });
  }

 private:
  using Tree = typename Grid::TreeType;
  using Leaf = typename Tree::LeafNodeType;
  using Region = typename Tree::RootNodeType::ChildNodeType;
  using Block = typename Region::ChildNodeType;

  // A node, and the number of its first child.
  struct Node {
    VoxelIndex origin;
    std::size_t first;
  };

  template <typename Kind>
  static VoxelIndex origin_of(const VoxelIndex& voxel) {
    constexpr auto kMask = static_cast<std::int32_t>(Kind::DIM - 1);
    return {voxel.x() & ~kMask, voxel.y() & ~kMask, voxel.z() & ~kMask};
  }

  static openvdb::Index64 memory_of(const std::vector<VoxelIndex>& leaves) {
    Tree tree;
    for (const VoxelIndex& leaf : leaves) tree.touchLeaf(leaf);
    return tree.memUsage();
  }

  template <typename Number>
  static void write_number(std::ostream& stream, Number number) {
    stream.write(reinterpret_cast<const char*>(&number), sizeof(number));
  }

  std::span<const VoxelLeaf> leaves() const { return tree_.leaves(); }

  // A region without its blocks: all of its cells that are none have the background's value.
  void write_region(std::ostream& stream, const VoxelIndex& origin, std::span<const Node> blocks) const {
    typename Region::NodeMaskType children;
    const typename Region::NodeMaskType no_active_tiles;
    for (const Node& block : blocks) children.setOn(Region::coordToOffset(block.origin));
    stream.write(reinterpret_cast<const char*>(origin.asPointer()), 3 * sizeof(std::int32_t));
    children.save(stream);
    no_active_tiles.save(stream);
    std::vector<Value> tiles(Region::NUM_VALUES, background_);
    openvdb::io::writeCompressedValues(stream, tiles.data(), Region::NUM_VALUES, no_active_tiles, children,
                                       this->saveFloatAsHalf());
  }

  std::unique_ptr<Block> make_block(std::size_t number, bool with_values) const {
    const std::size_t end = number + 1 < blocks_.size() ? blocks_[number + 1].first : leaves().size();
    auto block = std::make_unique<Block>(blocks_[number].origin, background_);
    for (std::size_t i = blocks_[number].first; i < end; ++i) {
      block->addLeaf(make_leaf(leaves()[i], with_values).release());
    }
    return block;
  }

  std::unique_ptr<Leaf> make_leaf(const VoxelLeaf& source, bool with_values) const {
    auto leaf = with_values ? std::make_unique<Leaf>(source.origin(), background_)
                            : std::make_unique<Leaf>(openvdb::PartialCreate(), source.origin(), background_);
    leaf->setValueMask(source.getValueMask());
    if (with_values) {
      for_each_voxel(source, [&](const VoxelIndex& voxel, std::size_t record) {
        leaf->setValueOnly(Leaf::coordToOffset(voxel), value_of_(record));
      });
    }
    return leaf;
  }

  // Calls body(block) for the blocks [begin, end) in their order; some are made at the same time.
  template <typename Body>
  void for_each_block(std::size_t begin, std::size_t end, bool with_values, const Body& body) const {
    constexpr std::size_t kBlocksAtOnce = 32;
    std::vector<std::unique_ptr<Block>> made;
    for (; begin < end; begin += made.size()) {
      made.resize(std::min(kBlocksAtOnce, end - begin));
      parallel_for(made.size(), [&](std::size_t i) { made[i] = make_block(begin + i, with_values); });
      for (const std::unique_ptr<Block>& block : made) body(*block);
    }
  }

  const VoxelTree& tree_;
  std::size_t num_voxels_;
  ValueOf value_of_;
  Value background_ = openvdb::zeroVal<Value>();
  std::vector<Node> blocks_;
  std::vector<Node> regions_;
};

}  // namespace vdbmap
