// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vdb/diff_file.h"

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "tests/support/sample_maps.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/vdb/map_check.h"
#include "vdbmap/io/vdb/map_file.h"

namespace vdbmap {
namespace {

ChangedVoxels changed_voxels(const std::vector<VoxelIndex>& voxels, std::int32_t label) {
  ChangedVoxels result{test::map_of_voxels(voxels).finest(), {}};
  for (std::size_t i = 0; i < result.level.size(); ++i) {
    result.confidences.push_back(static_cast<float>(i % 11) / 10);
    result.level.channels().labels.push_back(label);
  }
  return result;
}

MapDiff sample_diff() {
  MapDiff diff{.frame = {{64, -128, 0}, 25832},
               .label_scheme = LabelScheme::kSemanticKitti,
               .counts = {2, 3, 1, 12'345'678'901, 2},
               .appeared = changed_voxels({{0, 0, 0}, {1, 0, 0}}, 10),
               .vanished = changed_voxels({{-9, 4, 2}, {200, -3, 7}, {201, -3, 7}}, 30),
               .changed = changed_voxels({{5, 5, 5}}, 50),
               .unobserved = test::map_of_voxels({{300, 300, 3}, {-300, 2, 2}}).finest().tree()};
  return diff;
}

TEST(DiffFile, GivesTheDiffBack) {
  const test::TemporaryFolder folder;
  const MapDiff diff = sample_diff();
  save_diff(folder / "diff.vdb", diff);
  const MapDiff read = load_diff(folder / "diff.vdb");
  EXPECT_EQ(read.frame, diff.frame);
  EXPECT_EQ(read.label_scheme, diff.label_scheme);
  EXPECT_EQ(read.counts, diff.counts);
  for (const auto kind : {&MapDiff::appeared, &MapDiff::vanished, &MapDiff::changed}) {
    const ChangedVoxels &a = diff.*kind, &b = read.*kind;
    EXPECT_TRUE(test::same_voxels(a.level, b.level));
    EXPECT_EQ(a.confidences, b.confidences);
    EXPECT_EQ(a.level.channels().labels, b.level.channels().labels);
    for (std::size_t i = 0; i < a.level.size(); ++i) {
      EXPECT_EQ(a.level.records()[i].mean_code, b.level.records()[i].mean_code);
      EXPECT_EQ(a.level.records()[i].covariance, b.level.records()[i].covariance);
      EXPECT_EQ(a.level.records()[i].count, b.level.records()[i].count);
    }
  }
  ASSERT_EQ(read.unobserved.leaves().size(), 2u);
  EXPECT_EQ(read.unobserved.voxel_box(), diff.unobserved.voxel_box());
}

TEST(DiffFile, KeepsTheRulesThatBlenderNeeds) {
  const test::TemporaryFolder folder;
  save_diff(folder / "diff.vdb", sample_diff());
  for (const RuleResult& rule : check_map_file(folder / "diff.vdb"))
    EXPECT_TRUE(rule.passed) << rule.name << ": " << rule.detail;
}

TEST(DiffFile, OfNoChangeIsAFileToo) {
  const test::TemporaryFolder folder;
  VoxelMap map = test::map_of_voxels({{0, 0, 0}});
  save_diff(folder / "diff.vdb", map_diff({map}, {map}));
  const MapDiff read = load_diff(folder / "diff.vdb");
  EXPECT_EQ(read.counts.unchanged, 1u);
  EXPECT_EQ(read.appeared.level.size(), 0u);
  for (const RuleResult& rule : check_map_file(folder / "diff.vdb"))
    EXPECT_TRUE(rule.passed) << rule.name << ": " << rule.detail;
}

TEST(DiffFile, IsAMapInTheColorsOfItsKinds) {
  const test::TemporaryFolder folder;
  save_diff(folder / "diff.vdb", sample_diff());
  const VoxelMap map = load_map(folder / "diff.vdb");
  EXPECT_EQ(map.finest().size(), 6u);
  const VoxelFinder finder(map.finest());
  const auto color = [&](const VoxelIndex& voxel) { return color_of(*finder.find(voxel)); };
  EXPECT_GT(color({0, 0, 0}).y(), 3 * color({0, 0, 0}).x());    // green
  EXPECT_GT(color({-9, 4, 2}).x(), 5 * color({-9, 4, 2}).y());  // red
  EXPECT_GT(color({5, 5, 5}).x(), 10 * color({5, 5, 5}).z());   // amber
}

TEST(DiffFile, EqualDiffsAreEqualFiles) {
  const test::TemporaryFolder folder;
  save_diff(folder / "a.vdb", sample_diff());
  save_diff(folder / "b.vdb", sample_diff());
  EXPECT_EQ(test::read_raw(folder / "a.vdb"), test::read_raw(folder / "b.vdb"));
}

TEST(DiffFile, RefusesAMap) {
  const test::TemporaryFolder folder;
  save_map(folder / "map.vdb", test::sample_map());
  EXPECT_FALSE(is_diff_file(folder / "map.vdb"));
  EXPECT_THROW(load_diff(folder / "map.vdb"), IoError);
  EXPECT_THROW(load_diff(folder / "missing.vdb"), IoError);
}

}  // namespace
}  // namespace vdbmap
