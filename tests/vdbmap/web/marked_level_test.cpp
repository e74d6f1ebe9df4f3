// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/web/marked_level.h"

#include <map>
#include <set>

#include <gtest/gtest.h>

#include "tests/support/random_points.h"
#include "tests/support/sample_maps.h"
#include "vdbmap/change/map_diff.h"

namespace vdbmap {
namespace {

// Voxels with one point each, and these labels.
VoxelLevel level_of(const std::map<VoxelIndex, int>& voxels) {
  std::vector<VoxelIndex> list;
  for (const auto& [voxel, label] : voxels) list.push_back(voxel);
  VoxelMap map = test::map_of_voxels(list);
  VoxelLevel level = std::move(map.levels.front());
  level.channels().labels.resize(level.size());
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t i) { level.channels().labels[i] = voxels.at(voxel); });
  return level;
}

std::map<VoxelIndex, int> labels_of(const VoxelLevel& level) {
  std::map<VoxelIndex, int> labels;
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t i) { labels[voxel] = level.channels().labels[i]; });
  return labels;
}

constexpr int kAppeared = static_cast<int>(Change::kAppeared);
constexpr int kVanished = static_cast<int>(Change::kVanished);
constexpr int kUnobserved = static_cast<int>(Change::kUnobserved);

TEST(MarkedLevel, HasTheVoxelsOfTheLevelAndThoseThatVanished) {
  std::map<VoxelIndex, int> level, marks, expected, expected_marks;
  for (const VoxelIndex& voxel : test::random_voxels(900, -20, 20, 5)) {
    const std::size_t kind = expected.size() % 3;
    if (kind < 2) level[voxel] = 40;
    if (kind == 1) marks[voxel] = kAppeared;
    if (kind == 2) marks[voxel] = kVanished;
    expected[voxel] = kind < 2 ? 40 : 10;
    expected_marks[voxel] = kind == 0 ? 0 : marks[voxel];
  }
  std::map<VoxelIndex, int> before;
  for (const auto& [voxel, mark] : marks) before[voxel] = 10;
  const VoxelLevel level_before = level_of(before);
  const MarkedLevel marked = with_marks(level_of(level), level_of(marks), &level_before);
  EXPECT_EQ(labels_of(marked.voxels), expected);
  EXPECT_EQ(labels_of(*marked.marks), expected_marks);
}

TEST(MarkedLevel, WhatIsInNeitherMapDoesNotCount) {
  const MarkedLevel marked = with_marks(level_of({{{0, 0, 0}, 40}}), level_of({{{5, 0, 0}, kUnobserved}}), nullptr);
  EXPECT_EQ(labels_of(*marked.marks), (std::map<VoxelIndex, int>{{{0, 0, 0}, 0}}));
}

TEST(MarkedLevel, WithoutTheMapBeforeVanishedVoxelsAreThoseOfTheDiff) {
  const VoxelLevel marks = level_of({{{5, 0, 0}, kVanished}});
  const MarkedLevel marked = with_marks(level_of({{{0, 0, 0}, 40}}), marks, nullptr);
  EXPECT_EQ(labels_of(marked.voxels), (std::map<VoxelIndex, int>{{{0, 0, 0}, 40}, {{5, 0, 0}, 0}}));
  EXPECT_EQ(marked.voxels.records().back(), marks.records().front());
}

TEST(MarkedLevel, AParentIsMarkedAsMostOfItsMarkedChildren) {
  const MarkedLevel marked =
      with_marks(level_of({{{0, 0, 0}, 40}, {{1, 0, 0}, 40}, {{0, 1, 0}, 40}, {{4, 0, 0}, 40}}),
                 level_of({{{0, 1, 0}, kAppeared}, {{1, 1, 0}, kVanished}, {{1, 1, 1}, kVanished}}), nullptr);
  EXPECT_EQ(labels_of(*marked.coarsened().marks), (std::map<VoxelIndex, int>{{{0, 0, 0}, kVanished}, {{2, 0, 0}, 0}}));
  EXPECT_EQ(labels_of(marked.coarsened().voxels), (std::map<VoxelIndex, int>{{{0, 0, 0}, 40}, {{2, 0, 0}, 40}}));
}

}  // namespace
}  // namespace vdbmap
