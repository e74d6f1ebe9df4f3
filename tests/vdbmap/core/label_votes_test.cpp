// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/label_votes.h"

#include <algorithm>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/brute_force.h"
#include "tests/support/random_points.h"
#include "tests/support/sample_maps.h"
#include "vdbmap/core/map_builder.h"

namespace vdbmap {
namespace {

const Eigen::AlignedBox3d kFewVoxels(Eigen::Vector3d(-1.3, -0.2, -0.1), Eigen::Vector3d(0.4, 0.3, 0.1));

// The label of most votes, the lowest of several.
std::int32_t winner_of(const std::map<std::int32_t, std::int64_t>& votes) {
  const auto best = std::ranges::max_element(votes, {}, [](const auto& entry) { return entry.second; });
  return best == votes.end() ? kNoLabel : best->first;
}

std::int32_t winner_among(const PointCloud& cloud, const std::vector<std::size_t>& numbers) {
  std::map<std::int32_t, std::int64_t> votes;
  for (const std::size_t i : numbers) {
    if (cloud.labels[i] != kNoLabel) ++votes[cloud.labels[i]];
  }
  return winner_of(votes);
}

TEST(LabelVotes, AVoxelHasTheLabelOfMostOfItsPoints) {
  const PointCloud cloud = test::random_cloud(3'000, kFewVoxels, 1);
  const VoxelMap map = build_map(cloud, test::anchored({0, 0, 0}));
  const test::PointsByVoxel voxels = test::points_by_voxel(cloud.positions, 0.1);
  ASSERT_EQ(map.finest().channels().labels.size(), voxels.size());
  for_each_voxel(map.finest(), [&](const VoxelIndex& voxel, std::size_t number) {
    EXPECT_EQ(map.finest().channels().labels[number], winner_among(cloud, voxels.at(voxel))) << voxel;
  });
}

TEST(LabelVotes, ACoarseVoxelHasTheLabelOfTheFineOnesWithMostPoints) {
  const PointCloud cloud = test::random_cloud(2'000, kFewVoxels, 2);
  const VoxelMap map = build_map(cloud, test::anchored({0, 0, 0}));
  std::map<VoxelIndex, std::map<std::int32_t, std::int64_t>> votes;
  for_each_voxel(map.finest(), [&](const VoxelIndex& voxel, std::size_t number) {
    const std::int32_t label = map.finest().channels().labels[number];
    if (label != kNoLabel) votes[parent_of_voxel(voxel, 10)][label] += map.finest().records()[number].count;
  });
  ASSERT_EQ(map.coarsest().channels().labels.size(), map.coarsest().size());
  for_each_voxel(map.coarsest(), [&](const VoxelIndex& voxel, std::size_t number) {
    EXPECT_EQ(map.coarsest().channels().labels[number], winner_of(votes[voxel])) << voxel;
  });
}

TEST(LabelVotes, PointsWithoutAClassDoNotVote) {
  PointCloud cloud;
  cloud.positions.assign(6, {0.05, 0.05, 0.05});
  cloud.labels = {0, 0, 0, 0, 0, 7};
  cloud.positions.emplace_back(1.05, 0.05, 0.05);
  cloud.labels.push_back(0);
  EXPECT_EQ(build_map(cloud).finest().channels().labels, (std::vector<std::int32_t>{7, kNoLabel}));
}

TEST(LabelVotes, CloudsWithoutLabelsDoNotVote) {
  PointCloud labelled;
  labelled.positions = {{0.05, 0.05, 0.05}};
  labelled.labels = {9};
  PointCloud plain;
  plain.positions = {{0.02, 0.05, 0.05}, {0.03, 0.05, 0.05}, {0.55, 0.05, 0.05}};
  MapBuilder builder(test::anchored({0, 0, 0}));
  builder.add(plain);
  builder.add(labelled);
  EXPECT_EQ(builder.finish().finest().channels().labels, (std::vector<std::int32_t>{9, kNoLabel}));
  builder.add(labelled);
  EXPECT_EQ(builder.finish(plain).finest().channels().labels, (std::vector<std::int32_t>{9, kNoLabel}));
  builder.add(plain);
  EXPECT_TRUE(builder.finish().finest().channels().labels.empty());
}

TEST(LabelVotes, MergingEqualsVotingTogether) {
  std::mt19937 random(3);
  std::vector<LabelVotes> all;
  std::vector<std::vector<LabelVotes>> parts(3);
  for (int i = 0; i < 2'000; ++i) {
    const VoxelKey voxel{random() % 50};
    const auto label = static_cast<std::int32_t>(random() % 5);
    add_vote(all, voxel, label);
    add_vote(parts[random() % 3], voxel, label);
  }
  sort_votes(all);
  std::vector<LabelVotes> merged;
  for (std::vector<LabelVotes>& part : parts) {
    sort_votes(part);
    merged = merge_votes(merged, part);
  }
  EXPECT_EQ(merged, all);
  std::int64_t num_votes = 0;
  for (const LabelVotes& votes : all) num_votes += votes.count;
  EXPECT_LT(num_votes, 2'000);
  EXPECT_GT(num_votes, 1'400);
  EXPECT_TRUE(merge_votes({}, {}).empty());
}

TEST(LabelVotes, TheLowerOfTwoLabelsWinsATie) {
  const std::vector<LabelVotes> votes = {{VoxelKey{3}, 5, 2}, {VoxelKey{3}, 8, 2}, {VoxelKey{9}, 1, 1}};
  LabelElection election(votes);
  EXPECT_EQ(election.winner(VoxelKey{1}), kNoLabel);
  EXPECT_EQ(election.winner(VoxelKey{3}), 5);
  EXPECT_EQ(election.winner(VoxelKey{9}), 1);
  EXPECT_EQ(election.winner(VoxelKey{10}), kNoLabel);
}

}  // namespace
}  // namespace vdbmap
