// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/web/change_marks.h"

#include <map>

#include <gtest/gtest.h>

#include "tests/support/sample_maps.h"

namespace vdbmap {
namespace {

ChangedVoxels one_voxel(const VoxelIndex& voxel) { return {test::map_of_voxels({voxel}).finest(), {1.0f}}; }

TEST(ChangeMarks, SayOfEachVoxelWhatBecameOfIt) {
  const MapDiff diff{.frame = {},
                     .label_scheme = LabelScheme::kUnknown,
                     .counts = {},
                     .appeared = one_voxel({0, 0, 0}),
                     .vanished = one_voxel({-9, 4, 2}),
                     .changed = one_voxel({100, 0, 1}),
                     .unobserved = test::map_of_voxels({{7, 7, 7}, {0, 0, 1}}).finest().tree()};
  const VoxelLevel marks = change_marks(diff);
  std::map<VoxelIndex, std::int32_t> found;
  std::map<VoxelIndex, std::uint32_t> counts;
  for_each_voxel(marks, [&](const VoxelIndex& voxel, std::size_t record) {
    found[voxel] = marks.channels().labels[record];
    counts[voxel] = marks.records()[record].count;
  });
  EXPECT_EQ(found, (std::map<VoxelIndex, std::int32_t>{
                       {{0, 0, 0}, 1}, {{-9, 4, 2}, 2}, {{100, 0, 1}, 3}, {{7, 7, 7}, 4}, {{0, 0, 1}, 4}}));
  EXPECT_EQ(counts, (std::map<VoxelIndex, std::uint32_t>{
                        {{0, 0, 0}, 1}, {{-9, 4, 2}, 1}, {{100, 0, 1}, 1}, {{7, 7, 7}, 0}, {{0, 0, 1}, 0}}));
  EXPECT_EQ(marks.voxel_size(), 0.1);
}

}  // namespace
}  // namespace vdbmap
