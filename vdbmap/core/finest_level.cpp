// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/finest_level.h"

#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "vdbmap/core/parallel.h"

namespace vdbmap {
namespace {

// Adds some blocks of the points, in parallel.
void add_blocks(VoxelBlocks& blocks, const SortedPoints& points, const std::vector<std::size_t>& block_numbers) {
  std::vector<BlockContent*> targets;
  for (const std::size_t i : block_numbers) targets.push_back(&blocks[points.block(i)]);
  parallel_for(block_numbers.size(), [&](std::size_t i) {
    targets[i]->sums = merge_blocks(std::move(targets[i]->sums), points.fold(block_numbers[i]));
    targets[i]->votes = merge_votes(targets[i]->votes, points.votes(block_numbers[i]));
  });
}

// What a block of the level is made of: what is known, or points.
struct BlockSource {
  BlockKey block;
  std::size_t first_record;
  BlockContent* content;
  std::size_t in_points;  // number of the block there, if there is no content
};

// Makes the level of its blocks, all at the same time.
class LevelMaker {
 public:
  LevelMaker(VoxelBlocks blocks, const SortedPoints* points, const FinestLevelOptions& options)
      : blocks_(std::move(blocks)), points_(points), options_(options) {}

  VoxelLevel make() {
    if (points_) add_to_known_blocks();
    list_sources();
    allocate();
    std::vector<std::vector<VoxelLeaf>> leaves_of_source(sources_.size());
    parallel_for(sources_.size(), [&](std::size_t i) { leaves_of_source[i] = make_block(sources_[i]); });
    return {options_.voxel_size, join(std::move(leaves_of_source)), std::move(records_), std::move(channels_)};
  }

 private:
  void add_to_known_blocks() {
    std::vector<std::size_t> known;
    for (std::size_t i = 0; i < points_->num_blocks(); ++i) {
      if (blocks_.contains(points_->block(i))) known.push_back(i);
    }
    add_blocks(blocks_, *points_, known);
  }

  // Both lists are sorted; a block of both has got its points by now.
  void list_sources() {
    std::size_t next = 0;
    for (auto& [block, content] : blocks_) {
      list_points_before(block, next);
      if (points_ && next < points_->num_blocks() && points_->block(next) == block) ++next;
      add_source({block, num_records_, &content, 0}, content.sums.size());
    }
    if (points_) {
      for (; next < points_->num_blocks(); ++next) add_points_source(next);
    }
  }

  void list_points_before(BlockKey block, std::size_t& next) {
    for (; points_ && next < points_->num_blocks() && points_->block(next) < block; ++next) add_points_source(next);
  }

  void add_points_source(std::size_t number) {
    add_source({points_->block(number), num_records_, nullptr, number}, points_->num_voxels(number));
  }

  void add_source(const BlockSource& source, std::size_t num_voxels) {
    sources_.push_back(source);
    num_records_ += num_voxels;
  }

  void allocate() {
    records_.resize(num_records_);
    if (options_.has_intensity) channels_.intensities.resize(num_records_);
    if (options_.has_labels) channels_.labels.resize(num_records_);
    if (options_.epoch) {
      channels_.first_epochs.assign(num_records_, *options_.epoch);
      channels_.last_epochs = channels_.first_epochs;
    }
  }

  static LargeVector<VoxelLeaf> join(std::vector<std::vector<VoxelLeaf>> parts) {
    std::size_t count = 0;
    for (const auto& part : parts) count += part.size();
    LargeVector<VoxelLeaf> leaves;
    leaves.reserve(count);
    for (auto& part : parts) {
      leaves.insert(leaves.end(), part.begin(), part.end());
      part = {};  // not both at once
    }
    return leaves;
  }

  std::vector<VoxelLeaf> make_block(const BlockSource& source) {
    BlockMaker maker(*this, source);
    if (source.content) {
      const BlockSums voxels = std::move(source.content->sums);  // freed as soon as they are converted
      for (const KeyedSums& voxel : voxels) maker.add(voxel.key, voxel.sums);
    } else {
      points_->for_each_voxel(source.in_points, [&](KeyInBlock key, std::span<const KeyedPoint> points) {
        maker.add(key, points_->sums_of(points));
      });
    }
    return maker.take_leaves();
  }

  // Makes the voxels of one block, which come in the order of their keys.
  class BlockMaker {
   public:
    BlockMaker(LevelMaker& level, const BlockSource& source)
        : level_(level),
          block_(source.block),
          record_(source.first_record),
          leaves_(source.block),
          votes_(source.content ? std::move(source.content->votes) : level.points_->votes(source.in_points)),
          election_(votes_) {}
    BlockMaker(const BlockMaker&) = delete;
    BlockMaker& operator=(const BlockMaker&) = delete;

    void add(KeyInBlock key, const VoxelSums& sums) {
      VoxelChannels& channels = level_.channels_;
      leaves_.add(key);
      level_.records_[record_] = record_of(sums, level_.options_.voxel_size);
      if (!channels.intensities.empty()) channels.intensities[record_] = intensity_of(sums);
      if (!channels.labels.empty()) channels.labels[record_] = election_.winner(key_of_voxel(block_, key));
      ++record_;
    }

    std::vector<VoxelLeaf> take_leaves() { return leaves_.take(); }

   private:
    LevelMaker& level_;
    BlockKey block_;
    std::size_t record_;
    BlockLeaves leaves_;
    std::vector<LabelVotes> votes_;
    LabelElection election_;  // of votes_
  };

  VoxelBlocks blocks_;
  const SortedPoints* points_;
  const FinestLevelOptions& options_;
  std::vector<BlockSource> sources_;
  std::size_t num_records_ = 0;
  LargeVector<VoxelRecord> records_;
  VoxelChannels channels_;
};

}  // namespace

void add_content(BlockContent& content, BlockContent added) {
  content.sums = merge_blocks(std::move(content.sums), std::move(added.sums));
  content.votes = content.votes.empty() ? std::move(added.votes) : merge_votes(content.votes, added.votes);
}

void add_points(VoxelBlocks& blocks, const SortedPoints& points) {
  std::vector<std::size_t> all(points.num_blocks());
  std::iota(all.begin(), all.end(), std::size_t{0});
  add_blocks(blocks, points, all);
}

VoxelLevel make_finest_level(VoxelBlocks blocks, const SortedPoints* last_points, const FinestLevelOptions& options) {
  return LevelMaker(std::move(blocks), last_points, options).make();
}

}  // namespace vdbmap
