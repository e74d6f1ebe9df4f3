// SPDX-License-Identifier: GPL-3.0-or-later
// Files made to be read into memory that they do not hold, or over memory that is not theirs.
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <openvdb/points/AttributeArray.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "tests/support/sample_maps.h"
#include "vdbmap/io/vdb/map_check.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/io/vdb/standard_grids.h"
#include "vdbmap/io/vdb/vdb_file.h"

namespace vdbmap {
namespace {

using openvdb::points::PointDataGrid;
using Leaf = openvdb::points::PointDataTree::LeafNodeType;

class HostileVoxels : public testing::Test {
 protected:
  using Change = std::function<void(PointDataGrid&)>;

  // What is said of a map of three voxels whose finest grid was changed.
  std::string load_error(const Change& change) const {
    save_map(folder_ / "map.vdb", test::map_of_voxels({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    VdbContent content = read_vdb(folder_ / "map.vdb");
    for (const auto& grid : content.grids) {
      if (grid->getName() == "voxels") change(dynamic_cast<PointDataGrid&>(*grid));
    }
    write_vdb(folder_ / "map.vdb", {content.grids.begin(), content.grids.end()}, *content.metadata);
    return test::io_error_of([&] { load_map(folder_ / "map.vdb"); });
  }

  bool check_passes() const { return all_passed(check_map_file(folder_ / "map.vdb")); }

  test::TemporaryFolder folder_;
};

void set_offsets(Leaf& leaf, openvdb::Index first, openvdb::Index last) {
  std::vector<Leaf::ValueType> offsets(Leaf::SIZE, Leaf::ValueType(last));
  offsets.front() = Leaf::ValueType(first);
  leaf.setOffsets(offsets, /*updateValueMask=*/false);
}

TEST_F(HostileVoxels, OffsetsThatPromiseMorePointsThanALeafHasVoxels) {
  const std::string message =
      load_error([](PointDataGrid& grid) { set_offsets(*grid.tree().beginLeaf(), 3, 4'000'000'000u); });
  EXPECT_EQ(
      message,
      "map.vdb: grid 'voxels' has a leaf of 4000000000 points, expected at most one for each of its 32768 voxels");
  EXPECT_FALSE(check_passes());
}

TEST_F(HostileVoxels, OffsetsThatPromiseMorePointsThanTheAttributesHave) {
  EXPECT_NE(
      load_error([](PointDataGrid& grid) { set_offsets(*grid.tree().beginLeaf(), 3, 30'000); }).find("lacks attribute"),
      std::string::npos);
  EXPECT_FALSE(check_passes());
}

TEST_F(HostileVoxels, OffsetsThatRunBackwards) {
  EXPECT_EQ(load_error([](PointDataGrid& grid) { set_offsets(*grid.tree().beginLeaf(), 4'000'000'000u, 3); }),
            "map.vdb: grid 'voxels' has broken point offsets");
  EXPECT_FALSE(check_passes());
}

// One value stands for all points of a leaf, so that leaves of 32,768 points take a hundred bytes each.
TEST_F(HostileVoxels, MoreVoxelsThanTheFileCanHold) {
  const std::string message = load_error([](PointDataGrid& grid) {
    const auto descriptor = grid.tree().beginLeaf()->attributeSet().descriptorPtr();
    for (int i = 1; i <= 100; ++i) {
      Leaf& leaf = *grid.tree().touchLeaf(openvdb::Coord(8 * i, 0, 0));
      leaf.replaceAttributeSet(new openvdb::points::AttributeSet(descriptor, 32'768),
                               /*allowMismatchingDescriptors=*/true);
      set_offsets(leaf, 64, 32'768);
    }
  });
  EXPECT_NE(message.find("grid 'voxels' holds 3276803 voxels, a file of its size at most"), std::string::npos)
      << message;
}

TEST_F(HostileVoxels, CellsWhoseVoxelsHaveNoIndex) {
  for (const int cell : {1 << 29, (1 << 30) + 64, -(1 << 30), 1 << 18}) {  // times 4: 2^31, beyond it twice, 2^20
    const std::string message = load_error([&](PointDataGrid& grid) {
      const Leaf& source = *grid.tree().cbeginLeaf();
      auto moved = std::make_unique<Leaf>(source);
      moved->setOrigin(openvdb::Coord(cell, 0, 0));
      grid.tree().addLeaf(moved.release());
    });
    EXPECT_EQ(message, "map.vdb: grid 'voxels' has a voxel beyond the addressable range") << cell;
    EXPECT_FALSE(check_passes());
  }
}

// OpenVDB's own reader goes on behind the end of a file, making nodes of nothing.
TEST_F(HostileVoxels, NodesThatTheFileDoesNotHold) {
  const auto density = openvdb::FloatGrid::create();
  density->setName("density");
  density->fill({openvdb::Coord(0), openvdb::Coord(9)}, 1.0F);
  openvdb::io::File(folder_ / "whole.vdb").write(openvdb::GridCPtrVec{density});
  const std::string whole = test::read_raw(folder_ / "whole.vdb");
  // The root: background, number of tiles, number of nodes, and of the only node its origin and which children it has.
  const std::size_t root = whole.find(test::raw(0.0F, 0U, 1U, 0, 0, 0));
  ASSERT_NE(root, std::string::npos);
  const std::string many = test::raw(0xffffffffU);
  for (const auto& [place, bytes] :
       {std::pair(root + 4, many), std::pair(root + 8, many), std::pair(root + 24, std::string(4096, '\xff'))}) {
    std::string broken = whole;
    test::write_raw(folder_ / "broken.vdb", broken.replace(place, bytes.size(), bytes));
    EXPECT_EQ(test::io_error_of([&] { read_vdb(folder_ / "broken.vdb"); }),
              "broken.vdb: is damaged: a grid goes on beyond the end of the file");
  }
}

// The rules name the first place that breaks them: one text for each would take far more than the voxels.
TEST_F(HostileVoxels, ValuesThatAreNotFiniteAreCountedNotGathered) {
  const auto density = openvdb::FloatGrid::create();
  density->setName("density");
  density->setGridClass(openvdb::GRID_FOG_VOLUME);
  density->denseFill({openvdb::Coord(0), openvdb::Coord(63)}, std::numeric_limits<float>::quiet_NaN());
  write_vdb(folder_ / "nan.vdb", {density}, {});
  for (const RuleResult& rule : check_map_file(folder_ / "nan.vdb")) {
    if (rule.name != "finite_values") continue;
    EXPECT_NE(rule.detail.find("voxel [0, 0, 0]: not finite (and 262143 more)"), std::string::npos) << rule.detail;
  }
}

}  // namespace
}  // namespace vdbmap
