// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vdb/streamed_grid.h"

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/random_points.h"
#include "tests/support/sample_maps.h"
#include "vdbmap/io/vdb/map_grids.h"
#include "vdbmap/io/vdb/vdb_file.h"

namespace vdbmap {
namespace {

float value_of(std::size_t record) { return 0.37f * static_cast<float>(record) - 5; }

// The grid as OpenVDB makes it, voxel by voxel.
openvdb::FloatGrid::Ptr whole_grid(const VoxelLevel& level) {
  auto grid = openvdb::FloatGrid::create();
  auto accessor = grid->getAccessor();
  for_each_voxel(level,
                 [&](const VoxelIndex& voxel, std::size_t record) { accessor.setValue(voxel, value_of(record)); });
  return grid;
}

class StreamedGridOf : public testing::TestWithParam<std::int32_t> {
 protected:
  openvdb::FloatGrid::Ptr read_back(const openvdb::GridBase::Ptr& grid, bool as_half) const {
    grid->setName("g");
    grid->setSaveFloatAsHalf(as_half);
    write_vdb_grid_by_grid(folder_ / "g.vdb", {[&] { return grid; }}, {});
    return openvdb::gridPtrCast<openvdb::FloatGrid>(read_vdb(folder_ / "g.vdb").grids.at(0));
  }

  test::TemporaryFolder folder_;
};

TEST_P(StreamedGridOf, IsReadBackAsTheWholeTree) {
  const VoxelMap map = test::map_of_voxels(test::random_voxels(GetParam() == 0 ? 0 : 3000, -GetParam(), GetParam(), 1));
  for (const VoxelLevel& level : map.levels) {
    for (const bool as_half : {false, true}) {
      const auto expected = read_back(whole_grid(level), as_half);
      const auto found = read_back(make_channel_grid<openvdb::FloatGrid>(level, value_of), as_half);
      ASSERT_TRUE(found->tree().hasSameTopology(expected->tree()));
      for (auto value = expected->cbeginValueAll(); value; ++value) {
        ASSERT_EQ(found->tree().getValue(value.getCoord()), *value) << value.getCoord();
      }
      for (const char* name : {"file_bbox_min", "file_bbox_max", "file_mem_bytes", "file_voxel_count"}) {
        EXPECT_EQ(*(*found)[name], *(*expected)[name]) << name;
      }
    }
  }
}

// Nothing; within blocks of 128; over many blocks, and over several regions of 4096.
INSTANTIATE_TEST_SUITE_P(Reaches, StreamedGridOf, testing::Values(0, 12, 400, 9000));

}  // namespace
}  // namespace vdbmap
