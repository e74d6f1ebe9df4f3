// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vdb/vdb_file.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/folders.h"

namespace vdbmap {
namespace {

class VdbFile : public testing::Test {
 protected:
  // Grids of these names with 1, 2, 3, ... voxels each.
  void write(const std::vector<std::string>& names) const {
    openvdb::GridCPtrVec grids;
    for (const std::string& name : names) {
      auto grid = openvdb::FloatGrid::create();
      grid->setName(name);
      for (int i = 0; i <= static_cast<int>(grids.size()); ++i) grid->tree().setValueOn(openvdb::Coord(i, 0, 0), 1.0F);
      grids.push_back(grid);
    }
    openvdb::MetaMap metadata;
    metadata.insertMeta("author", openvdb::StringMetadata("somebody"));
    write_vdb(folder_ / "a.vdb", grids, metadata);
  }

  std::vector<openvdb::Index64> sizes_of(const VdbContent& content) const {
    std::vector<openvdb::Index64> sizes;
    for (const openvdb::GridBase::Ptr& grid : content.grids) sizes.push_back(grid->activeVoxelCount());
    std::ranges::sort(sizes);
    return sizes;
  }

  test::TemporaryFolder folder_;
};

TEST_F(VdbFile, WithoutAFilterAllGridsAreRead) {
  write({"b", "a", "c"});
  const VdbContent content = read_vdb(folder_ / "a.vdb");
  EXPECT_EQ(sizes_of(content), (std::vector<openvdb::Index64>{1, 2, 3}));
  EXPECT_EQ(content.metadata->getMetadata<openvdb::StringMetadata>("author")->value(), "somebody");
}

TEST_F(VdbFile, OnlyGridsThatAreWantedAreRead) {
  write({"voxels", "density", "voxels_1m", "color"});
  const VdbContent content =
      read_vdb(folder_ / "a.vdb", [](const std::string& name) { return name.starts_with("voxels"); });
  EXPECT_EQ(sizes_of(content), (std::vector<openvdb::Index64>{1, 3}));
  const VdbContent none = read_vdb(folder_ / "a.vdb", [](const std::string&) { return false; });
  EXPECT_TRUE(none.grids.empty());
  EXPECT_TRUE(none.metadata->getMetadata<openvdb::StringMetadata>("author"));
}

// OpenVDB writes a tree that several grids share once, and the others without an offset of it.
TEST_F(VdbFile, GridsThatShareATreeAreAllRead) {
  const auto density = openvdb::FloatGrid::create();
  density->setName("density");
  density->fill({openvdb::Coord(0), openvdb::Coord(9)}, 1.0F);
  const auto heat = density->copy();
  heat->setName("heat");
  openvdb::io::File(folder_ / "a.vdb").write(openvdb::GridCPtrVec{density, heat});
  EXPECT_EQ(sizes_of(read_vdb(folder_ / "a.vdb")), (std::vector<openvdb::Index64>{1000, 1000}));
  const auto is_heat = [](const std::string& name) { return name == "heat"; };
  EXPECT_EQ(sizes_of(read_vdb(folder_ / "a.vdb", is_heat)), (std::vector<openvdb::Index64>{1000}));
}

TEST_F(VdbFile, GridsOfOneNameAreAllRead) {
  write({"voxels", "density", "voxels"});
  const VdbContent content =
      read_vdb(folder_ / "a.vdb", [](const std::string& name) { return name.starts_with("voxels"); });
  EXPECT_EQ(sizes_of(content), (std::vector<openvdb::Index64>{1, 3}));
}

}  // namespace
}  // namespace vdbmap
