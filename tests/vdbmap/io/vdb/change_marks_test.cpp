// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vdb/change_marks.h"

#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "tests/support/sample_maps.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/io/vdb/vdb_file.h"

namespace vdbmap {
namespace {

using Marked = std::map<std::string, std::vector<VoxelIndex>>;

class ChangeMarksTest : public testing::Test {
 protected:
  // A map file with float grids beside it, as OpenVDB makes them.
  std::filesystem::path write(const VoxelMap& map, const Marked& marked) const {
    save_map(folder_ / "map.vdb", map);
    const VdbContent content = read_vdb(folder_ / "map.vdb");
    openvdb::GridCPtrVec grids(content.grids.begin(), content.grids.end());
    for (const auto& [name, voxels] : marked) {
      auto grid = openvdb::FloatGrid::create();
      grid->setName(name);
      for (const VoxelIndex& voxel : voxels) grid->tree().setValue(voxel, 0.9f);
      grids.push_back(grid);
    }
    write_vdb(folder_ / "diff.vdb", grids, *content.metadata);
    return folder_ / "diff.vdb";
  }

  test::TemporaryFolder folder_;
};

TEST_F(ChangeMarksTest, AreThoseOfTheGrids) {
  const VoxelMap map = test::map_of_voxels({{0, 0, 0}, {-9, 4, 2}, {100, 0, 1}});
  const ChangeMarks marks = load_change_marks(write(map, {{"appeared", {{0, 0, 0}}},
                                                          {"vanished", {{-9, 4, 2}, {0, 0, 0}}},
                                                          {"changed", {{100, 0, 1}}},
                                                          {"unobserved", {{7, 7, 7}}}}));
  std::map<VoxelIndex, std::int32_t> found;
  for_each_voxel(marks.level, [&](const VoxelIndex& voxel, std::size_t i) {
    found[voxel] = marks.level.channels().labels[i];
    const VoxelRecord* const record = VoxelFinder(map.finest()).find(voxel);
    EXPECT_EQ(marks.level.records()[i], record ? *record : VoxelRecord()) << voxel;
  });
  EXPECT_EQ(found,
            (std::map<VoxelIndex, std::int32_t>{{{0, 0, 0}, 1}, {{-9, 4, 2}, 2}, {{100, 0, 1}, 3}, {{7, 7, 7}, 4}}));
  EXPECT_EQ(marks.frame, map.frame);
  EXPECT_EQ(marks.level.voxel_size(), 0.1);
}

TEST_F(ChangeMarksTest, OfAMapAreRefused) {
  const VoxelMap map = test::map_of_voxels({{0, 0, 0}});
  EXPECT_EQ(test::io_error_of([&] { load_change_marks(write(map, {})); }),
            "diff.vdb: is no diff: it has no grid 'changed'");
  EXPECT_EQ(test::io_error_of([&] {
              load_change_marks(write(map, {{"appeared", {}}, {"vanished", {}}, {"changed", {}}}));
            }),
            "diff.vdb: is no diff: it has no grid 'unobserved'");
}

}  // namespace
}  // namespace vdbmap
