// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/sorted_points.h"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/brute_force.h"
#include "tests/support/random_points.h"

namespace vdbmap {
namespace {

const Eigen::AlignedBox3d kAcrossBlocks(Eigen::Vector3d(-15, -2, -1), Eigen::Vector3d(14, 2, 1));

struct FoldedBlock {
  BlockKey block;
  BlockSums voxels;
};

std::vector<FoldedBlock> folded(const PointCloud& cloud, std::size_t begin, std::size_t end) {
  const SortedPoints points(cloud, begin, end, Eigen::Isometry3d::Identity(), 10);
  std::vector<FoldedBlock> blocks;
  for (std::size_t i = 0; i < points.num_blocks(); ++i) {
    blocks.push_back({points.block(i), points.fold(i)});
    EXPECT_EQ(blocks.back().voxels.size(), points.num_voxels(i));
  }
  return blocks;
}

VoxelSums total(const std::vector<FoldedBlock>& blocks) {
  VoxelSums sum;
  for (const FoldedBlock& block : blocks) {
    for (const KeyedSums& voxel : block.voxels) sum.add(voxel.sums);
  }
  return sum;
}

TEST(SortedPoints, AnyPartOfACloudIsLikeACloudOfItsOwn) {
  const PointCloud cloud = test::random_cloud(60'000, kAcrossBlocks, 1);  // several tasks of 16,384 points
  for (const auto& [begin, end] :
       std::vector<std::pair<std::size_t, std::size_t>>{{0, 1}, {7, 20'000}, {20'000, 60'000}}) {
    const std::vector<FoldedBlock> part = folded(cloud, begin, end);
    const std::vector<FoldedBlock> alone = folded(test::part_of(cloud, begin, end), 0, end - begin);
    ASSERT_EQ(part.size(), alone.size());
    for (std::size_t i = 0; i < part.size(); ++i) {
      EXPECT_EQ(part[i].block, alone[i].block);
      ASSERT_EQ(part[i].voxels.size(), alone[i].voxels.size());
      for (std::size_t v = 0; v < part[i].voxels.size(); ++v) {
        EXPECT_EQ(part[i].voxels[v].key, alone[i].voxels[v].key);
        EXPECT_EQ(part[i].voxels[v].sums.position, alone[i].voxels[v].sums.position);
        EXPECT_EQ(part[i].voxels[v].sums.color, alone[i].voxels[v].sums.color);
        EXPECT_EQ(part[i].voxels[v].sums.intensity, alone[i].voxels[v].sums.intensity);
      }
    }
  }
}

TEST(SortedPoints, EveryPointIsCountedOnceInItsVoxel) {
  // Up to some thousand points a block: both ways of sorting.
  for (const std::size_t count : {10UL, 511UL, 512UL, 50'000UL}) {
    const PointCloud cloud = test::random_cloud(count, kAcrossBlocks, 2);
    const std::vector<FoldedBlock> blocks = folded(cloud, 0, count);
    const test::PointsByVoxel expected = test::points_by_voxel(cloud.positions, 0.1);
    std::size_t num_voxels = 0;
    for (const FoldedBlock& block : blocks) num_voxels += block.voxels.size();
    EXPECT_EQ(num_voxels, expected.size());
    EXPECT_EQ(total(blocks).count, static_cast<std::int64_t>(count));
  }
}

TEST(SortedPoints, WhatIdsDoNotReachIsLeftOut) {
  PointCloud cloud = test::random_cloud(40'000, kAcrossBlocks, 4);
  const std::vector<FoldedBlock> expected = folded(cloud, 0, 40'000);
  const auto add = [&](std::size_t place, const Eigen::Vector3d& point) {
    const auto at = [place](auto& values) { return values.begin() + static_cast<std::ptrdiff_t>(place); };
    cloud.positions.insert(at(cloud.positions), point);
    cloud.colors.insert(at(cloud.colors), Rgb16{});
    cloud.intensities.insert(at(cloud.intensities), 0.0f);
    cloud.labels.insert(at(cloud.labels), std::uint16_t{0});
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Eigen::Vector3d& far :
       {Eigen::Vector3d(1e6, 0, 0), Eigen::Vector3d(0, nan, 0), Eigen::Vector3d(0, 0, -1e300)}) {
    add(17'000, far);
  }
  add(30'000, {0, 104'857.6, 0});
  const SortedPoints points(cloud, 5, cloud.size(), Eigen::Isometry3d::Identity(), 10);
  EXPECT_EQ(points.num_unreachable(), 4U);
  EXPECT_EQ(points.first_unreachable(), 17'000U);

  const std::vector<FoldedBlock> found = folded(cloud, 0, cloud.size());
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(found[i].voxels.size(), expected[i].voxels.size());
    for (std::size_t v = 0; v < found[i].voxels.size(); ++v) {
      EXPECT_EQ(found[i].voxels[v].key, expected[i].voxels[v].key);
      EXPECT_EQ(found[i].voxels[v].sums.count, expected[i].voxels[v].sums.count);
      EXPECT_EQ(found[i].voxels[v].sums.color, expected[i].voxels[v].sums.color);
    }
  }
}

TEST(SortedPoints, BlocksAndVoxelsComeSortedAndOnce) {
  const std::vector<FoldedBlock> blocks = folded(test::random_cloud(50'000, kAcrossBlocks, 3), 0, 50'000);
  ASSERT_GT(blocks.size(), 3U);
  for (std::size_t i = 1; i < blocks.size(); ++i) EXPECT_LT(blocks[i - 1].block, blocks[i].block);
  for (const FoldedBlock& block : blocks) {
    const auto not_rising = [](const KeyedSums& a, const KeyedSums& b) { return a.key >= b.key; };
    EXPECT_EQ(std::adjacent_find(block.voxels.begin(), block.voxels.end(), not_rising), block.voxels.end());
  }
}

}  // namespace
}  // namespace vdbmap
