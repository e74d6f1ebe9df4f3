// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/coarse/level_features.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "tests/support/sample_maps.h"
#include "tests/support/synthetic_scene.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/store/city_of_map.h"
#include "vdbmap/store/city_writer.h"

namespace vdbmap::registration {
namespace {

// A village over the corner of four tiles, and the same three tiles to the east: with tiles between that have nothing.
VoxelMap two_villages(const Eigen::Vector3d& shift) {
  PointCloud cloud = test::survey_of_village();
  const PointCloud other = test::moved(cloud, Eigen::Isometry3d(Eigen::Translation3d(shift)));
  cloud.positions.insert(cloud.positions.end(), other.positions.begin(), other.positions.end());
  return build_map(cloud, test::anchored(Eigen::Vector3d::Zero()));
}

MapWindows open(
    const std::filesystem::path& city, const TileChoice& is_wanted = [](const CityTile&) { return true; }) {
  return {open_city(city), is_wanted};
}

bool are_same(const LevelFeatures& a, const LevelFeatures& b) {
  return a.features == b.features && a.points.positions == b.points.positions && a.points.normals == b.points.normals &&
         a.points.planarities == b.points.planarities;
}

std::size_t num_kept(const std::filesystem::path& city) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(city / "cache"))
    count += entry.is_regular_file() ? 1 : 0;
  return count;
}

TEST(LevelFeatures, OfACityAreThoseOfItsMapComputedOrKept) {
  const test::TemporaryFolder folder;
  const VoxelMap map = two_villages({192, 20, 0});
  const CityManifest manifest = save_city(folder / "city", map);
  const LevelFeatures expected = features_of_level(map.coarsest(), {});
  EXPECT_TRUE(are_same(features_of_map(map, {}), expected));
  EXPECT_TRUE(are_same(features_of_map(open(folder / "city"), {}), expected));
  EXPECT_EQ(num_kept(folder / "city"), manifest.tiles.size());
  EXPECT_TRUE(are_same(features_of_map(open(folder / "city"), {}), expected));
  // Some are kept, some are computed with what lies around them.
  std::size_t number = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "city" / "cache")) {
    if (number++ % 3 == 0) test::write_raw(entry.path(), "damaged");
  }
  EXPECT_TRUE(are_same(features_of_map(open(folder / "city"), {}), expected));
  EXPECT_FALSE(are_same(features_of_map(open(folder / "city"), {7, 4}), expected));
}

// Else they would be written anew.
TEST(LevelFeatures, AreReadFromWhereTheyAreKept) {
  const test::TemporaryFolder folder;
  const CityManifest manifest = save_city(folder / "city", two_villages({192, 20, 0}));
  features_of_map(open(folder / "city"), {});
  std::vector<std::filesystem::file_time_type> before, after;
  const auto times = [&] {
    std::vector<std::filesystem::file_time_type> all;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "city" / "cache")) {
      all.push_back(entry.last_write_time());
    }
    return all;
  };
  before = times();
  features_of_map(open(folder / "city"), {});
  after = times();
  EXPECT_EQ(before, after);
}

// After an epoch that moved the second village, features near it are computed anew, and those of the first are kept.
TEST(LevelFeatures, FollowTheTilesThatChange) {
  const test::TemporaryFolder folder;
  save_city(folder / "city", two_villages({192, 20, 0}));
  features_of_map(open(folder / "city"), {});
  const VoxelMap later = two_villages({200, 24, 0});
  {
    const CityManifest other = save_city(folder / "other", later);
    CityWriter writer(folder / "city");
    for (const CityTile& tile : other.tiles) {
      std::filesystem::copy_file(tile_path(folder / "other", tile), tile_path(folder / "city", tile),
                                 std::filesystem::copy_options::overwrite_existing);
    }
    writer.publish(other, 1);
  }
  const LevelFeatures expected = features_of_level(later.coarsest(), {});
  EXPECT_TRUE(are_same(features_of_map(open(folder / "city"), {}), expected));
  EXPECT_TRUE(are_same(features_of_map(open(folder / "city"), {}), expected));
}

// At the border of what is looked at, features are those of what is looked at, and spoil nothing for others.
TEST(LevelFeatures, OfSomeTilesAreThoseOfASmallerMap) {
  const test::TemporaryFolder folder;
  const VoxelMap map = two_villages({192, 20, 0});
  save_city(folder / "city", map);
  const auto is_west = [](const CityTile& tile) { return tile.id.x < 0; };
  features_of_map(open(folder / "city"), {});
  const MapWindows west = open(folder / "city", is_west);
  EXPECT_TRUE(are_same(features_of_map(west, {}), features_of_level(west.overview().coarsest(), {})));
  EXPECT_TRUE(are_same(features_of_map(open(folder / "city"), {}), features_of_level(map.coarsest(), {})));
}

}  // namespace
}  // namespace vdbmap::registration
