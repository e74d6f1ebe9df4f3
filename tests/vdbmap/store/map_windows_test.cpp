// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/map_windows.h"

#include <filesystem>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/city_folders.h"
#include "tests/support/folders.h"
#include "tests/support/sample_maps.h"
#include "vdbmap/core/error.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/store/city_of_map.h"

namespace vdbmap {
namespace {

const Eigen::Vector3d kWest(-120, 5, 0), kEast(120, 5, 0);  // [m] 240 m apart, in a street of 300 m

class MapWindowsTest : public testing::Test {
 protected:
  MapWindowsTest() { save_city(path(), test::street_of_tiles()); }

  std::filesystem::path path() const { return folder_ / "city"; }

  MapWindows windows(std::size_t kept_bytes = 0) const {
    return {open_city(path()), [](const CityTile&) { return true; }, kept_bytes};
  }

  test::TemporaryFolder folder_;
};

// The tiles of the street less than `radius` [m] from a place, their voxels' extents being the whole of them.
std::vector<TileId> tiles_near(const Eigen::Vector3d& place, double radius) {
  std::vector<TileId> near;
  for (const TileId& tile : tiles_of(test::street_of_tiles())) {
    const Extent box = *extent(cut_tile(test::street_of_tiles(), tile));
    const bool is_near = (place.array() - radius <= box.max.array()).head<2>().all() &&
                         (place.array() + radius >= box.min.array()).head<2>().all();
    if (is_near) near.push_back(tile);
  }
  return near;
}

std::string difference_at(const VoxelMap& window, const Eigen::Vector3d& place, double radius) {
  const std::vector<TileId> near = tiles_near(place, radius);
  if (tiles_of(window) != near) return "other tiles";
  for (const TileId& tile : near) {
    const std::string difference = test::difference(cut_tile(window, tile), cut_tile(test::street_of_tiles(), tile));
    if (!difference.empty()) return difference;
  }
  return "";
}

TEST_F(MapWindowsTest, AroundAPlaceLieTheTilesNearIt) {
  const MapWindows map = windows();
  EXPECT_EQ(difference_at(*map.around(kWest, 20), kWest, 20), "");
  EXPECT_EQ(difference_at(*map.around(kEast, 100), kEast, 100), "");
  EXPECT_EQ(difference_at(*map.around(kEast, 60), kEast, 60), "");  // from tiles of the window before
  EXPECT_EQ(test::difference(*map.around(kWest, 1000), test::street_of_tiles()), "");
  EXPECT_EQ(map.around({5000, 0, 0}, 100)->finest().size(), 0u);
}

TEST_F(MapWindowsTest, TheOverviewIsTheMapWithoutItsFinestLevel) {
  VoxelMap expected = test::street_of_tiles();
  expected.levels.front() = VoxelLevel(0.1, {}, {});
  EXPECT_EQ(test::difference(windows().overview(), expected), "");
  EXPECT_EQ(windows().voxel_sizes(), (std::vector{0.1, 1.0, 8.0}));
}

TEST_F(MapWindowsTest, OfAMapInMemoryEveryWindowIsTheMap) {
  const MapWindows map(test::street_of_tiles());
  EXPECT_EQ(&map.overview(), &test::street_of_tiles());
  EXPECT_EQ(map.around(kWest, 1).get(), &test::street_of_tiles());
}

TEST_F(MapWindowsTest, ManyThreadsMayLookAtATime) {
  const MapWindows map = windows();
  std::vector<std::string> differences(64);
  parallel_for(differences.size(), [&](std::size_t i) {
    const Eigen::Vector3d place(-140 + 4.4 * static_cast<double>(i), 5, 0);
    differences[i] = difference_at(*map.around(place, 30), place, 30);
  });
  for (const std::string& difference : differences) EXPECT_EQ(difference, "");
}

TEST_F(MapWindowsTest, ForgetsWhatLiesBehind) {
  const MapWindows map = windows();
  const std::weak_ptr<const VoxelMap> west = map.around(kWest, 20);
  map.around({0, 5, 0}, 20);
  EXPECT_FALSE(west.expired());  // one of the last two
  map.around(kEast, 20);
  EXPECT_TRUE(west.expired());
  const MapWindows roomy = windows(std::size_t{1} << 30);
  const std::weak_ptr<const VoxelMap> kept = roomy.around(kWest, 20);
  roomy.around({0, 5, 0}, 20);
  roomy.around(kEast, 20);
  EXPECT_EQ(roomy.around(kWest, 20), kept.lock());
}

TEST_F(MapWindowsTest, ReadsNoTileOutOfReach) {
  const MapWindows map = windows();
  const City city = open_city(path());
  for (const CityTile& tile : city.manifest.tiles) {
    if (tile.extent.max.x() < 0) std::filesystem::remove(tile_path(path(), tile));
  }
  EXPECT_EQ(difference_at(*map.around(kEast, 20), kEast, 20), "");
  EXPECT_THROW(map.around(kWest, 20), IoError);
  EXPECT_THROW(map.overview(), IoError);
}

}  // namespace
}  // namespace vdbmap
