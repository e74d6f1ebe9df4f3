// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/label_votes.h"

#include <algorithm>
#include <iterator>
#include <tuple>

#include "vdbmap/core/parallel.h"

namespace vdbmap {
namespace {

bool comes_first(const LabelVotes& a, const LabelVotes& b) {
  return std::tie(a.voxel, a.label) < std::tie(b.voxel, b.label);
}

bool are_for_the_same(const LabelVotes& a, const LabelVotes& b) { return a.voxel == b.voxel && a.label == b.label; }

// Of sorted votes, makes one of those that are for the same.
void add_up(std::vector<LabelVotes>& votes) {
  auto last = votes.begin();
  for (auto next = votes.begin(); next != votes.end(); ++next) {
    if (next == last) continue;
    if (are_for_the_same(*last, *next)) {
      last->count += next->count;
    } else {
      *++last = *next;
    }
  }
  if (!votes.empty()) votes.erase(std::next(last), votes.end());
}

}  // namespace

void add_vote(std::vector<LabelVotes>& votes, VoxelKey voxel, std::int32_t label, std::int64_t count) {
  if (label == kNoLabel) return;
  const LabelVotes vote{voxel, label, count};
  if (!votes.empty() && are_for_the_same(votes.back(), vote)) {
    votes.back().count += count;
  } else {
    votes.push_back(vote);
  }
}

void sort_votes(std::vector<LabelVotes>& votes) {
  if (!std::ranges::is_sorted(votes, comes_first)) std::ranges::sort(votes, comes_first);
  add_up(votes);
}

std::vector<LabelVotes> merge_votes(const std::vector<LabelVotes>& a, const std::vector<LabelVotes>& b) {
  std::vector<LabelVotes> merged;
  merged.reserve(a.size() + b.size());
  std::ranges::merge(a, b, std::back_inserter(merged), comes_first);
  add_up(merged);
  return merged;
}

std::vector<LabelVotes> votes_for_parents(const VoxelLevel& fine, std::int32_t factor) {
  constexpr std::size_t kLeavesPerRange = 256;
  const std::span<const VoxelLeaf> leaves = fine.leaves();
  const std::vector<std::int32_t>& labels = fine.channels().labels;
  std::vector<std::vector<LabelVotes>> ranges((leaves.size() + kLeavesPerRange - 1) / kLeavesPerRange);
  parallel_for(ranges.size(), [&](std::size_t i) {
    const std::size_t end = std::min(leaves.size(), (i + 1) * kLeavesPerRange);
    for (std::size_t leaf = i * kLeavesPerRange; leaf < end; ++leaf) {
      for_each_voxel(leaves[leaf], [&](const VoxelIndex& voxel, std::size_t number) {
        const VoxelKey parent = key_of_voxel(parent_of_voxel(voxel, factor));
        add_vote(ranges[i], parent, labels[number], fine.records()[number].count);
      });
    }
    sort_votes(ranges[i]);
  });

  std::vector<LabelVotes> votes;
  for (const std::vector<LabelVotes>& range : ranges) votes.insert(votes.end(), range.begin(), range.end());
  sort_votes(votes);
  return votes;
}

std::int32_t LabelElection::winner(VoxelKey voxel) {
  while (!rest_.empty() && rest_.front().voxel < voxel) rest_ = rest_.subspan(1);
  LabelVotes best;
  for (; !rest_.empty() && rest_.front().voxel == voxel; rest_ = rest_.subspan(1)) {
    if (rest_.front().count > best.count) best = rest_.front();
  }
  return best.label;
}

}  // namespace vdbmap
