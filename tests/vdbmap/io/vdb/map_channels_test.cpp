// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vdb/map_channels.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "tests/support/sample_maps.h"
#include "vdbmap/core/hierarchy.h"
#include "vdbmap/core/normals.h"
#include "vdbmap/io/vdb/map_grids.h"
#include "vdbmap/io/vdb/vdb_file.h"

namespace vdbmap {
namespace {

using openvdb::FloatGrid;
using openvdb::GridBase;
using openvdb::Int32Grid;
using openvdb::Vec3f;
using openvdb::Vec3SGrid;

class MapChannels : public testing::Test {
 protected:
  // What a file with these grids and no metadata of ours gives.
  VoxelMap import(const openvdb::GridPtrVec& grids, const openvdb::MetaMap& metadata = {}) const {
    const auto path = folder_ / "channels.vdb";
    write_vdb(path, {grids.begin(), grids.end()}, metadata);
    return import_channels(path);
  }

  std::string error(const openvdb::GridPtrVec& grids) const {
    return test::io_error_of([&] { import(grids); });
  }

  test::TemporaryFolder folder_;
};

template <typename Grid>
typename Grid::Ptr make_grid(const std::string& name, const std::vector<VoxelIndex>& voxels,
                             const typename Grid::ValueType& value, double voxel_size = 0.1) {
  const auto grid = Grid::create();
  for (const VoxelIndex& voxel : voxels) grid->tree().setValueOn(voxel, value);
  grid->setName(name);
  grid->setTransform(transform_of_level(voxel_size));
  return grid;
}

// What somebody makes by hand: 27 voxels with three points each on a plane across z.
struct HandMade {
  std::vector<VoxelIndex> voxels;
  Int32Grid::Ptr count;
  Vec3SGrid::Ptr mean;
  Vec3SGrid::Ptr cov_diag;
  Vec3SGrid::Ptr cov_offdiag;

  HandMade() {
    for (int x = -2; x <= 2; ++x) {
      for (int y = -2; y <= 2; ++y) voxels.emplace_back(x, y, -1);
    }
    count = make_grid<Int32Grid>("count", voxels, 3);
    mean = make_grid<Vec3SGrid>("mean", voxels, Vec3f(0.01f, 0, -0.02f));
    cov_diag = make_grid<Vec3SGrid>("cov_diag", voxels, Vec3f(1e-4f, 1e-4f, 0));
    cov_offdiag = make_grid<Vec3SGrid>("cov_offdiag", voxels, Vec3f(0));
  }
  openvdb::GridPtrVec grids() const { return {count, mean, cov_diag, cov_offdiag}; }
  openvdb::GridPtrVec grids_and(const GridBase::Ptr& more) const { return {count, mean, cov_diag, cov_offdiag, more}; }
};

TEST_F(MapChannels, ExportedMapsComeBackBitForBit) {
  for (const VoxelMap& map : {test::sample_map(), test::sample_map_without_attributes()}) {
    for (const bool integers_as_float : {false, true}) {
      export_channels(folder_ / "channels.vdb", map, {.integers_as_float = integers_as_float});
      EXPECT_EQ(test::difference(import_channels(folder_ / "channels.vdb"), map), "");
    }
  }
}

TEST_F(MapChannels, AMapOfOneLevelComesBackWithOneLevel) {
  VoxelMap map = test::sample_map();
  map.levels.pop_back();
  export_channels(folder_ / "channels.vdb", map);
  EXPECT_EQ(test::difference(import_channels(folder_ / "channels.vdb"), map), "");
}

TEST_F(MapChannels, EveryAttributeHasItsGrid) {
  export_channels(folder_ / "channels.vdb", test::sample_map());
  std::map<std::string, std::string> type_of_name;
  for (const GridBase::Ptr& grid : read_vdb(folder_ / "channels.vdb").grids) {
    type_of_name[grid->getName()] = grid->valueType();
    EXPECT_TRUE(grid->getMetadata<openvdb::DoubleMetadata>("anchor_y")) << grid->getName();
  }
  const std::map<std::string, std::string> expected = {
      {"density", "float"},   {"count", "int32"},       {"mean", "vec3s"},       {"cov_diag", "vec3s"},
      {"normal", "vec3s"},    {"cov_offdiag", "vec3s"}, {"planarity", "float"},  {"color", "vec3s"},
      {"intensity", "float"}, {"first_epoch", "int32"}, {"last_epoch", "int32"}, {"label", "int32"}};
  for (const auto& [name, type] : expected) {
    EXPECT_EQ(type_of_name[name], type) << name;
    EXPECT_EQ(type_of_name[name + "_1m"], type) << name;
  }
  EXPECT_EQ(type_of_name.size(), 2 * expected.size());
}

TEST_F(MapChannels, FloatsThatCannotHoldAnIntegerAreRefused) {
  VoxelMap map = test::sample_map();
  map.levels.front().records().front().count = (1 << 24) + 1;
  EXPECT_THROW(export_channels(folder_ / "channels.vdb", map, {.integers_as_float = true}), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "channels.vdb"));
}

TEST_F(MapChannels, HandMadeChannelsGetNormalsAndACoarserLevel) {
  const HandMade made;
  const VoxelMap map = import(made.grids());

  EXPECT_EQ(map.frame, MapFrame());
  EXPECT_FALSE(map.has_color);
  ASSERT_EQ(map.levels.size(), 2u);
  EXPECT_EQ(map.finest().voxel_size(), 0.1);
  ASSERT_EQ(map.finest().size(), made.voxels.size());
  VoxelFinder finder(map.finest());
  const VoxelRecord* record = finder.find({-1, 0, -1});
  ASSERT_NE(record, nullptr);
  EXPECT_EQ(record->count, 3u);
  // A step of the mean is 6 um.
  EXPECT_NEAR((mean_of(*record, {-1, 0, -1}, 0.1) - Eigen::Vector3d(-0.04, 0.05, -0.07)).norm(), 0, 1e-5);
  EXPECT_NEAR(normal_of(*record).z(), 1, 1e-4);
  EXPECT_GT(planarity_of(*record), 0.9);

  EXPECT_EQ(map.coarsest().voxel_size(), 1.0);
  EXPECT_EQ(map.coarsest().size(), 4u);
  EXPECT_EQ(num_points(map.coarsest()), 75u);
}

TEST_F(MapChannels, AnchorsOfOtherProgramsMayBeIntegers) {
  openvdb::MetaMap metadata;
  metadata.insertMeta("anchor_x", openvdb::Int32Metadata(640));
  metadata.insertMeta("anchor_y", openvdb::DoubleMetadata(-64));
  metadata.insertMeta("epsg", openvdb::Int32Metadata(25832));
  const MapFrame frame = import(HandMade().grids(), metadata).frame;
  EXPECT_EQ(frame.anchor, Eigen::Vector3d(640, -64, 0));
  EXPECT_EQ(frame.epsg, 25832);
}

TEST_F(MapChannels, CountsMayBeWholeFloats) {
  HandMade made;
  EXPECT_EQ(
      num_points(
          import({make_grid<FloatGrid>("count", made.voxels, 7), made.mean, made.cov_diag, made.cov_offdiag}).finest()),
      7 * made.voxels.size());
  for (const float count : {2.5f, 0x1p31f, std::numeric_limits<float>::quiet_NaN()}) {
    EXPECT_NE(error({make_grid<FloatGrid>("count", made.voxels, count), made.mean, made.cov_diag, made.cov_offdiag})
                  .find("expected a whole number"),
              std::string::npos);
  }
}

TEST_F(MapChannels, TilesAreVoxelsToo) {
  const openvdb::CoordBBox box(VoxelIndex(0), VoxelIndex(7));
  HandMade made;
  for (const auto& grid : {made.mean, made.cov_diag, made.cov_offdiag}) grid->clear();
  made.count->clear();
  made.count->sparseFill(box, 1);
  for (const auto& grid : {made.mean, made.cov_diag, made.cov_offdiag}) grid->sparseFill(box, Vec3f(0));
  ASSERT_EQ(made.count->tree().activeTileCount(), 1u);
  EXPECT_EQ(import(made.grids()).finest().size(), 512u);
}

TEST_F(MapChannels, TilesThatWouldFillTheMemoryAreRefused) {
  const openvdb::CoordBBox box(VoxelIndex(0), VoxelIndex(4095));
  HandMade made;
  made.count->sparseFill(box, 1);
  EXPECT_TRUE(
      error(made.grids()).starts_with("channels.vdb: grid 'count' has tiles that make 68719476761 voxels of it"))
      << error(made.grids());
}

// 2^21 voxels of 44 bytes and more out of a file of a few kilobytes.
TEST_F(MapChannels, TilesMakeNoMoreVoxelsThanTheFileCanAccountFor) {
  const openvdb::CoordBBox box(VoxelIndex(0), VoxelIndex(127, 127, 127));
  HandMade made;
  for (const auto& grid : {made.mean, made.cov_diag, made.cov_offdiag}) grid->clear();
  made.count->clear();
  made.count->sparseFill(box, 1);
  for (const auto& grid : {made.mean, made.cov_diag, made.cov_offdiag}) grid->sparseFill(box, Vec3f(0));
  const std::string message = error(made.grids());
  EXPECT_NE(message.find("tiles that make 2097152 voxels"), std::string::npos) << message;
}

TEST_F(MapChannels, MissingGridsAreNamed) {
  const HandMade made;
  EXPECT_EQ(error({made.mean, made.cov_diag, made.cov_offdiag}), "channels.vdb: lacks grid 'count'");
  EXPECT_EQ(error({made.count, made.cov_diag, made.cov_offdiag}), "channels.vdb: lacks grid 'mean'");
  EXPECT_EQ(error({made.count, made.mean, made.cov_offdiag}), "channels.vdb: lacks grid 'cov_diag'");
  EXPECT_EQ(error({made.count, made.mean, made.cov_diag}), "channels.vdb: lacks grid 'cov_offdiag'");
  EXPECT_EQ(error(made.grids_and(made.mean->deepCopy())), "channels.vdb: grid 'mean' is there twice");
}

TEST_F(MapChannels, GridsThatDoNotFitTogetherAreNamed) {
  const HandMade made;
  EXPECT_EQ(error(made.grids_and(make_grid<FloatGrid>("normal", made.voxels, 1))),
            "channels.vdb: grid 'normal' is of type float, expected vec3s");
  EXPECT_EQ(error(made.grids_and(make_grid<FloatGrid>("intensity", {{0, 0, -1}}, 1))),
            "channels.vdb: grid 'intensity' has 1 voxels, 'count' has 25");
  std::vector<VoxelIndex> moved = made.voxels;
  moved.front() = {100, 0, 0};
  EXPECT_EQ(error(made.grids_and(make_grid<FloatGrid>("intensity", moved, 1))),
            "channels.vdb: grid 'intensity' lacks voxel [-2, -2, -1] of 'count'");
}

TEST_F(MapChannels, TransformsOtherThanTheLevelsAreNamed) {
  const HandMade made;
  made.mean->setTransform(openvdb::math::Transform::createLinearTransform(0.1));
  EXPECT_EQ(error(made.grids()),
            "channels.vdb: grid 'mean' has a transform other than the level's: expected uniform scale 0.100000 and "
            "translation 0.050000 on each axis");
  made.count->setTransform(openvdb::math::Transform::createLinearTransform(0.3));
  EXPECT_NE(error(made.grids()).find("has voxels of 0.300000 m, expected 0.001 to 8 m that divide 8 m"),
            std::string::npos);
  made.count->transform().preRotate(0.5);
  EXPECT_NE(error(made.grids()), "no error");
}

TEST_F(MapChannels, ValuesThatMakeNoSenseAreNamed) {
  const auto with = [&](auto grid_of, const auto& value) {
    HandMade made;
    (made.*grid_of)->tree().setValueOn(VoxelIndex(0, 0, -1), value);
    return error(made.grids());
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::string place = "channels.vdb: grid ";
  EXPECT_EQ(with(&HandMade::count, 0), place + "'count', voxel [0, 0, -1]: count is 0, expected 1 or more");
  EXPECT_EQ(with(&HandMade::count, -5), place + "'count', voxel [0, 0, -1]: count is -5, expected 1 or more");
  EXPECT_EQ(with(&HandMade::mean, Vec3f(0, nan, 0)), place + "'mean' is not finite in voxel [0, 0, -1]");
  EXPECT_EQ(with(&HandMade::cov_diag, Vec3f(0, 0, INFINITY)), place + "'cov_diag' is not finite in voxel [0, 0, -1]");
  EXPECT_EQ(with(&HandMade::mean, Vec3f(0, 0.06f, 0)),
            place + "'mean', voxel [0, 0, -1]: offset of 0.060000 m leaves the voxel");
  EXPECT_EQ(with(&HandMade::cov_diag, Vec3f(-1e-4f, 0, 0)),
            place + "'cov_diag', voxel [0, 0, -1]: variance is negative");
}

TEST_F(MapChannels, VoxelsBeyondTheAddressableRangeAreNamed) {
  HandMade made;
  const VoxelIndex far(kIndexLimit, 0, 0);
  made.count->tree().setValueOn(far, 1);
  for (const auto& grid : {made.mean, made.cov_diag, made.cov_offdiag}) grid->tree().setValueOn(far, Vec3f(0));
  EXPECT_EQ(error(made.grids()), "channels.vdb: grid 'count', voxel [1048576, 0, 0]: beyond the addressable range");
}

TEST_F(MapChannels, CoarserLevelsMustHoldTheSamePoints) {
  const HandMade made;
  const std::vector<VoxelIndex> parents = {{-1, -1, -1}, {0, -1, -1}, {-1, 0, -1}, {0, 0, -1}};
  openvdb::GridPtrVec grids = made.grids();
  grids.push_back(make_grid<Int32Grid>("count_1m", parents, 18, 1.0));
  for (const char* name : {"mean_1m", "cov_diag_1m", "cov_offdiag_1m"}) {
    grids.push_back(make_grid<Vec3SGrid>(name, parents, Vec3f(0), 1.0));
  }
  EXPECT_EQ(error(grids), "channels.vdb: grid 'count_1m' counts 72 points, 'count' 75");

  openvdb::gridPtrCast<Int32Grid>(grids[4])->tree().setValueOn(parents[0], 21);
  EXPECT_EQ(import(grids).levels.size(), 2u);
  grids.push_back(make_grid<Vec3SGrid>("color", made.voxels, Vec3f(1)));
  EXPECT_EQ(error(grids), "channels.vdb: lacks grid 'color_1m'");
  grids.back()->setName("color_2m");
  EXPECT_EQ(import(grids).levels.size(), 2u) << "grids of no level are passed over";
}

TEST_F(MapChannels, LevelsMustBearTheirSizeInTheName) {
  const HandMade made;
  made.count->setName("count_1m");
  made.mean->setName("mean_1m");
  made.cov_diag->setName("cov_diag_1m");
  made.cov_offdiag->setName("cov_offdiag_1m");
  EXPECT_EQ(error(made.grids()), "channels.vdb: grid 'count_1m' has voxels of 0.100000 m, so its name must be 'count'");
}

TEST_F(MapChannels, MapsAndForeignFilesAreRefusedWithTheReason) {
  save_map(folder_ / "map.vdb", test::sample_map());
  EXPECT_EQ(test::io_error_of([&] { import_channels(folder_ / "map.vdb"); }), "map.vdb: lacks grid 'count'");
}

}  // namespace
}  // namespace vdbmap
