// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vdb/vdb_description.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "vdbmap/io/vdb/vdb_file.h"

namespace vdbmap {
namespace {

class DescribeVdb : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
};

TEST_F(DescribeVdb, TellsWhatAGridHolds) {
  auto grid = openvdb::Vec3SGrid::create();
  grid->setName("wind");
  grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
  grid->tree().fill({{0, 0, 0}, {7, 7, 8}}, openvdb::Vec3f(1));  // a whole leaf as a tile, and one layer
  grid->insertMeta("author", openvdb::StringMetadata("somebody"));
  openvdb::MetaMap metadata;
  metadata.insertMeta("creator", openvdb::StringMetadata("another program"));
  write_vdb(folder_ / "wind.vdb", {grid}, metadata);

  const VdbDescription description = describe_vdb(folder_ / "wind.vdb");
  EXPECT_EQ(description.metadata, (TextMetadata{{"creator", "another program"}}));
  ASSERT_EQ(description.grids.size(), 1U);
  const GridDescription& wind = description.grids[0];
  EXPECT_EQ(wind.name, "wind");
  EXPECT_EQ(wind.type, "vec3s");
  EXPECT_EQ(wind.grid_class, "unknown");
  EXPECT_EQ(wind.num_active_voxels, 8U * 8 * 9);
  EXPECT_EQ(wind.bounding_box, openvdb::CoordBBox({0, 0, 0}, {7, 7, 8}));
  EXPECT_EQ(wind.voxel_size, openvdb::Vec3d(0.5));
  EXPECT_TRUE(wind.is_linear);
  EXPECT_NE(
      std::find(wind.metadata.begin(), wind.metadata.end(), std::pair<std::string, std::string>("author", "somebody")),
      wind.metadata.end());
}

TEST_F(DescribeVdb, AnEmptyGridHasNoBox) {
  write_vdb(folder_ / "empty.vdb", {openvdb::FloatGrid::create()}, {});
  const VdbDescription description = describe_vdb(folder_ / "empty.vdb");
  ASSERT_EQ(description.grids.size(), 1U);
  EXPECT_EQ(description.grids[0].num_active_voxels, 0U);
  EXPECT_FALSE(description.grids[0].bounding_box);
}

TEST_F(DescribeVdb, OtherFilesAreRefused) {
  test::write_raw(folder_ / "text.vdb", "no grids here");
  EXPECT_EQ(test::io_error_of([&] { describe_vdb(folder_ / "text.vdb"); }), "text.vdb: is not an OpenVDB file");
}

}  // namespace
}  // namespace vdbmap
