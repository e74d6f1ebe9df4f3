// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "vdbmap/core/label_scheme.h"
#include "vdbmap/core/voxel_block.h"
#include "vdbmap/core/voxel_level.h"

/// A voxel has the label of most of its points. Votes are counted in whole numbers: the winner depends neither on the
/// order of the points nor on how they were cut into scans, files or threads.
namespace vdbmap {

/// How many points of a voxel have a label.
struct LabelVotes {
  VoxelKey voxel{};
  std::int32_t label = kNoLabel;
  std::int64_t count = 0;

  bool operator==(const LabelVotes&) const = default;
};

/// Adds one vote; points without a class have none.
void add_vote(std::vector<LabelVotes>& votes, VoxelKey voxel, std::int32_t label, std::int64_t count = 1);

/// Sorts by voxel, then label, and adds up what is equal in both.
void sort_votes(std::vector<LabelVotes>& votes);

/// Sorted votes of both, added up.
std::vector<LabelVotes> merge_votes(const std::vector<LabelVotes>& a, const std::vector<LabelVotes>& b);

/// Sorted votes for the voxels above a level, whose edges are `factor` times as long: each voxel votes for its label
/// with all of its points.
std::vector<LabelVotes> votes_for_parents(const VoxelLevel& fine, std::int32_t factor);

/// Counts sorted votes. Keeps a reference.
class LabelElection {
 public:
  explicit LabelElection(std::span<const LabelVotes> votes) : rest_(votes) {}

  /// The label with most votes, the lowest of several; kNoLabel without any. Voxels come in the order of their keys.
  std::int32_t winner(VoxelKey voxel);

 private:
  std::span<const LabelVotes> rest_;
};

}  // namespace vdbmap
