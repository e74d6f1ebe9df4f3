// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/city_build.h"

#include <algorithm>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/city_folders.h"
#include "tests/support/folders.h"
#include "tests/support/laz_bytes.h"
#include "tests/support/raw_files.h"
#include "tests/support/sample_maps.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/threads.h"
#include "vdbmap/core/error.h"
#include "vdbmap/core/map_merge.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/io/las/las.h"
#include "vdbmap/io/map_from_files.h"
#include "vdbmap/io/ply/ply.h"
#include "vdbmap/store/city_window.h"

namespace vdbmap {
namespace {

// A piece of street, moved along x: pieces overlap, and lie across tiles.
PointCloud street_at(double x, unsigned seed) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(x, -20, 5);
  return test::moved(test::sample_scene(test::street(), 6, seed), pose);
}

PointCloud with_attributes(PointCloud cloud) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.intensities.push_back(static_cast<float>(i % 200));
    cloud.labels.push_back(static_cast<std::uint16_t>(i % 5));
    cloud.colors.push_back({static_cast<std::uint16_t>(257 * (i % 256)), 257 * 40, 257 * 80});
  }
  return cloud;
}

class CityBuildTest : public testing::Test {
 protected:
  MapInput file(const std::string& name, const PointCloud& cloud) const {
    write_ply(folder_ / name, cloud);
    return {{folder_ / name, std::nullopt}};
  }

  // Three files, one of them with attributes, in the order of their names.
  std::vector<MapInput> three_files() const {
    return {file("a.ply", street_at(0, 1)), file("b.ply", with_attributes(street_at(50, 2))),
            file("c.ply", street_at(-70, 3))};
  }

  std::filesystem::path city() const { return folder_ / "city"; }

  // What is in the folder must be the tiles of the map.
  void expect_tiles_of(const VoxelMap& map) const {
    City built = open_city(city());
    EXPECT_EQ(built.manifest.tiles.size(), tiles_of(map).size());
    EXPECT_EQ(test::difference(load_city(built), map), "");
  }

  static CityBuildOptions options(std::optional<std::int32_t> epoch = std::nullopt) {
    CityBuildOptions options;
    options.files.build.epoch = epoch;
    return options;
  }

  test::TemporaryFolder folder_;
};

using CityBuild = CityBuildTest;

TEST_F(CityBuild, IsTheMapThatIsBuiltInMemory) {
  const std::vector<MapInput> inputs = three_files();
  const CityBuilt built = build_city(city(), inputs, options());
  const MapFromFiles expected = build_map_from_files(inputs);
  expect_tiles_of(expected.map);
  EXPECT_EQ(built.notes.num_points, expected.notes.num_points);
  EXPECT_EQ(num_points(built.manifest), expected.notes.num_points);
  EXPECT_EQ(built.manifest.epoch, 0);
  ASSERT_EQ(built.added.size(), 3U);
  EXPECT_EQ(built.added[1].name, "b.ply");
  EXPECT_EQ(built.added[1].num_points, street_at(50, 2).size());
  EXPECT_EQ(built.manifest.layout.channels, (std::vector<std::string>{"intensity", "label"}));
  EXPECT_GT(built.manifest.tiles.size(), 3U);
}

TEST_F(CityBuild, MemoryThreadsAndOrderChangeNoByte) {
  std::vector<MapInput> inputs = three_files();
  build_city(city(), inputs, options(2));
  const auto expected = test::files_of_city(city());
  std::ranges::reverse(inputs);
  for (const int threads : {1, 4}) {
    CityBuildOptions little = options(2);
    little.memory_bytes = 1 << 20;
    const std::filesystem::path other = folder_ / ("other" + std::to_string(threads));
    test::on_threads(threads, [&] { return build_city(other, inputs, little).notes.num_points; });
    EXPECT_TRUE(test::files_of_city(other) == expected) << threads;
  }
}

TEST_F(CityBuild, ALargeFileIsReadInPieces) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(5e5, 5e6, 5);
  PointCloud cloud = with_attributes(test::moved(test::sample_scene(test::street(), 60, 1), pose));
  for (std::uint16_t& label : cloud.labels) label %= 3;
  ASSERT_GT(cloud.size(), 2U * 16'384);
  write_las(folder_ / "large.las", cloud, {.epsg = 25832});
  const MapInput large{{folder_ / "large.las", {}}};
  CityBuildOptions little = options();
  little.memory_bytes = 1 << 20;
  const CityBuilt built = build_city(city(), {large}, little);
  expect_tiles_of(build_map_from_files({large}).map);
  EXPECT_EQ(built.added[0].num_points, cloud.size());

  const std::string las = test::read_raw(folder_ / "large.las");
  test::write_raw(folder_ / "large.laz", test::compress_las(las, {.points_per_chunk = 5'000, .chunk_sizes = {}}));
  build_city(folder_ / "compressed", {{{folder_ / "large.laz", {}}}}, little);
  EXPECT_EQ(test::difference(load_map_or_city(folder_ / "compressed"), load_map_or_city(city())), "");

  // The first point lies astray: what anchors the map is told by all pieces together.
  cloud.positions.front() = Eigen::Vector3d(0, 0, 1);
  write_las(folder_ / "stray.las", cloud, {.resolution = 0.01});
  const MapInput stray{{folder_ / "stray.las", {}}};
  build_city(folder_ / "stray", {stray}, little);
  EXPECT_EQ(test::difference(load_map_or_city(folder_ / "stray"), build_map_from_files({stray}).map), "");
}

TEST_F(CityBuild, OtherLevelsHaveTheirTilesToo) {
  const std::vector<MapInput> inputs = three_files();
  CityBuildOptions coarse = options();
  coarse.files.build.voxel_sizes = {0.2, 1, 8};
  coarse.memory_bytes = 1 << 20;
  build_city(city(), inputs, coarse);
  expect_tiles_of(build_map_from_files(inputs, coarse.files).map);
}

TEST_F(CityBuild, AScanIsMovedByItsPose) {
  MapInput input = file("a.ply", with_attributes(street_at(0, 1)));
  input.map_from_scan = Eigen::Isometry3d(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()));
  input.map_from_scan->translation() = Eigen::Vector3d(3e5, 5e6, 40);
  build_city(city(), {input}, options());
  expect_tiles_of(build_map_from_files({input}).map);
}

TEST_F(CityBuild, TheSameFileTwiceIsCountedOnce) {
  const std::vector<MapInput> inputs = {file("a.ply", street_at(0, 1)), file("copy.ply", street_at(0, 1))};
  const CityBuilt built = build_city(city(), inputs, options());
  EXPECT_EQ(built.not_counted, (std::vector<std::string>{"copy.ply"}));
  EXPECT_EQ(built.notes.num_points, street_at(0, 1).size());
}

TEST_F(CityBuild, AddingIsMergingTheMaps) {
  const MapInput a = file("a.ply", street_at(0, 1));
  const MapInput b = file("b.ply", street_at(30, 2));
  build_city(city(), {a}, options(1));
  CityBuildOptions second = options(2);
  second.memory_bytes = 1 << 20;
  const CityBuilt added = add_to_city(city(), {b}, second);

  MapFromFilesOptions of_b;
  of_b.build.epoch = 2;
  of_b.build.anchor = added.manifest.layout.frame.anchor;
  MapFromFilesOptions of_a;
  of_a.build.epoch = 1;
  const VoxelMap map_a = build_map_from_files({a}, of_a).map;
  expect_tiles_of(merge_maps(map_a, build_map_from_files({b}, of_b).map));
  EXPECT_EQ(added.manifest.sources.size(), 2U);
  EXPECT_EQ(added.manifest.sources[1].epoch, 2);
  EXPECT_EQ(test::difference(load_map_or_city(city().string() + "@1"), map_a), "");
}

TEST_F(CityBuild, TilesFarFromWhatIsAddedStayTheSameFiles) {
  build_city(city(), {file("a.ply", street_at(0, 1)), file("b.ply", street_at(700, 2))}, options(1));
  const CityManifest before = open_city(city()).manifest;
  add_to_city(city(), {file("c.ply", street_at(705, 3))}, options(2));
  const CityManifest after = open_city(city()).manifest;
  std::size_t num_same = 0;
  for (const CityTile& tile : before.tiles) num_same += *find_tile(after, tile.id) == tile ? 1 : 0;
  EXPECT_GT(num_same, 0U);
  EXPECT_LT(num_same, before.tiles.size());
}

TEST_F(CityBuild, WhatOnlyTheAddedPointsKnowIsKnownOfAllTiles) {
  const MapInput a = file("a.ply", street_at(0, 1));
  const MapInput far = file("b.ply", with_attributes(street_at(1000, 2)));
  build_city(city(), {a}, options());
  const CityBuilt added = add_to_city(city(), {far}, options(3));
  MapFromFilesOptions of_far;
  of_far.build.epoch = 3;
  of_far.build.anchor = added.manifest.layout.frame.anchor;
  expect_tiles_of(merge_maps(build_map_from_files({a}).map, build_map_from_files({far}, of_far).map));
  EXPECT_TRUE(added.manifest.layout.has_color);
}

TEST_F(CityBuild, WhatOnlyTheCityKnowsStays) {
  const MapInput a = file("a.ply", with_attributes(street_at(0, 1)));
  const MapInput far = file("b.ply", street_at(1000, 2));
  build_city(city(), {a}, options(1));
  const CityBuilt added = add_to_city(city(), {far}, options());  // in the city's epoch
  MapFromFilesOptions of_far;
  of_far.build.epoch = 1;
  of_far.build.anchor = added.manifest.layout.frame.anchor;
  MapFromFilesOptions of_a;
  of_a.build.epoch = 1;
  expect_tiles_of(merge_maps(build_map_from_files({a}, of_a).map, build_map_from_files({far}, of_far).map));
}

TEST_F(CityBuild, ASourceThatIsCountedAlreadyIsLeftOut) {
  const std::vector<MapInput> inputs = three_files();
  build_city(city(), {inputs[0]}, options(1));
  const CityBuilt added = add_to_city(city(), {inputs[0], inputs[1]}, options(1));
  EXPECT_EQ(added.not_counted, (std::vector<std::string>{"a.ply"}));
  EXPECT_EQ(added.added.size(), 1U);

  const auto before = test::files_of_city(city());
  const CityBuilt again = add_to_city(city(), {inputs[0], inputs[1]}, options(1));
  EXPECT_EQ(again.not_counted, (std::vector<std::string>{"a.ply", "b.ply"}));
  EXPECT_EQ(again.manifest, added.manifest);
  EXPECT_TRUE(test::files_of_city(city()) == before);
}

TEST_F(CityBuild, TheSameCommandAgainGivesTheSameBytes) {
  const std::vector<MapInput> inputs = three_files();
  build_city(city(), inputs, options(1));
  const auto before = test::files_of_city(city());
  build_city(city(), inputs, options(1));
  EXPECT_TRUE(test::files_of_city(city()) == before);
}

TEST_F(CityBuild, WhatDoesNotFitChangesNothing) {
  const std::vector<MapInput> inputs = three_files();
  build_city(city(), {inputs[0]}, options(3));
  const auto before = test::files_of_city(city());
  EXPECT_THROW(build_city(city(), {inputs[1]}, options(3)), std::invalid_argument);  // would lose a.ply
  EXPECT_THROW(add_to_city(city(), {inputs[1]}, options(2)), std::invalid_argument);
  CityBuildOptions coarse = options(3);
  coarse.files.build.voxel_sizes = {0.2, 1};
  EXPECT_THROW(add_to_city(city(), {inputs[1]}, coarse), std::invalid_argument);
  test::write_raw(folder_ / "cut.ply", test::read_raw(folder_ / "b.ply").substr(0, 90));
  EXPECT_THROW(add_to_city(city(), {{{folder_ / "cut.ply", {}}}}, options(3)), IoError);
  EXPECT_THROW(add_to_city(city(), {{{folder_ / "none.ply", {}}}}, options(3)), IoError);
  EXPECT_THROW(add_to_city(city(), {file("far.ply", street_at(1e6, 1))}, options(3)), IoError);
  write_las(folder_ / "other.las", street_at(0, 5), {.epsg = 25833});
  EXPECT_TRUE(test::files_of_city(city()) == before);

  EXPECT_THROW(add_to_city(folder_ / "new", {inputs[1]}, options()), IoError);
  EXPECT_THROW(build_city(folder_ / "new", {{{folder_ / "cut.ply", {}}}}, options()), IoError);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "new"));
}

TEST_F(CityBuild, PointsOfAnotherSystemAreRefused) {
  write_las(folder_ / "a.las", street_at(0, 5), {.epsg = 25832});
  write_las(folder_ / "b.las", street_at(0, 6), {.epsg = 25833});
  const MapInput a{{folder_ / "a.las", {}}};
  const MapInput b{{folder_ / "b.las", {}}};
  build_city(city(), {a}, options());
  const auto before = test::files_of_city(city());
  EXPECT_EQ(test::io_error_of([&] { add_to_city(city(), {b}, options()); }),
            "city: points of EPSG:25833 do not go into a city of EPSG:25832");
  EXPECT_TRUE(test::files_of_city(city()) == before);
}

}  // namespace
}  // namespace vdbmap
