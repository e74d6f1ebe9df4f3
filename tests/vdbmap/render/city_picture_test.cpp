// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/city_picture.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/sample_maps.h"
#include "tests/support/synthetic_scene.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/render/voxel_view.h"
#include "vdbmap/store/city_of_map.h"
#include "vdbmap/store/city_window.h"

namespace vdbmap {
namespace {

constexpr double kApart = 192;  // [m] three tiles

// Two streets along y, side by side.
const VoxelMap& two_streets() {
  static const VoxelMap map = [] {
    PointCloud cloud = test::sample_scene(test::street(), 60, 1);
    const PointCloud other = test::moved(cloud, Eigen::Isometry3d(Eigen::Translation3d(kApart, 0, 0)));
    cloud.positions.insert(cloud.positions.end(), other.positions.begin(), other.positions.end());
    return build_map(cloud, test::anchored(Eigen::Vector3d::Zero()));
  }();
  return map;
}

class CityPicture : public testing::Test {
 protected:
  CityPicture() {
    save_city(folder_ / "city", two_streets());
    city_ = open_city(folder_ / "city");
  }

  std::uint64_t voxels_of_first_street() const {
    std::uint64_t count = 0;
    for (const CityTile& tile : city_.manifest.tiles) count += tile.id.x < 2 ? tile.num_voxels.front() : 0;
    return count;
  }

  test::TemporaryFolder folder_;
  City city_;
};

RenderOptions picture(View view, std::vector<double> camera) {
  RenderOptions options;
  options.size = {240, 160};
  options.view = view;
  options.camera = std::move(camera);
  options.color_by = ColorBy::kHeight;
  options.has_decoration = false;
  return options;
}

bool is_same(const RenderResult& a, const RenderResult& b) {
  return std::ranges::equal(a.image.pixels(), b.image.pixels());
}

VoxelMap without_finest(VoxelMap map) {
  map.levels.erase(map.levels.begin());
  return map;
}

TEST_F(CityPicture, ASmallCityIsDrawnAsItsMap) {
  for (const View view : {View::kPlan, View::kOrbit, View::kPerspective}) {
    EXPECT_TRUE(is_same(render_city(city_, picture(view, {})), render(two_streets(), picture(view, {}))));
  }
}

TEST_F(CityPicture, WithoutRoomForATileAllIsDrawnByTheNextLevel) {
  const RenderOptions plan = picture(View::kPlan, {kApart / 2, 0, 20});
  EXPECT_TRUE(is_same(render_city(city_, plan, {}, 1), render(without_finest(two_streets()), plan)));
}

TEST_F(CityPicture, AVoxelSmallerThanAPixelIsNotLoaded) {
  const RenderOptions plan = picture(View::kPlan, {kApart / 2, 0, 500});  // 2 m a pixel
  for (const CityTile& tile : city_.manifest.tiles) ASSERT_GT(tile.num_voxels.front(), 0u);
  const std::uint64_t almost_all = num_voxels(city_.manifest).front() - 1;
  EXPECT_TRUE(is_same(render_city(city_, plan, {}, almost_all), render(without_finest(two_streets()), plan)));
}

// From above the first street, whose tiles all have room: it is drawn as if it were alone.
TEST_F(CityPicture, WhatIsNearIsDrawnByTheFinestLevel) {
  const RenderOptions plan = picture(View::kPlan, {0, 0, 12});
  const VoxelMap alone = load_window(city_, [](const CityTile& tile) { return tile.id.x < 2; });
  const RenderResult expected = render(alone, plan);
  EXPECT_FALSE(is_same(render(without_finest(alone), plan), expected));
  RenderOptions by_label = plan;
  by_label.color_by = ColorBy::kNormal;  // colours of heights are those of the whole city
  EXPECT_TRUE(is_same(render_city(city_, by_label, {}, voxels_of_first_street()), render(alone, by_label)));
}

TEST_F(CityPicture, OfAKnownCameraOnlyWhatItMaySeeIsRead) {
  // Looking away from the second street.
  const RenderOptions view = picture(View::kPerspective, {0, 0, 2, 180, 0});
  for (const CityTile& tile : city_.manifest.tiles) {
    if (tile.extent.min.x() > kApart / 2) std::filesystem::remove(tile_path(city_.folder, tile));
  }
  EXPECT_NO_THROW(render_city(city_, view, {}, voxels_of_first_street()));
}

TEST(ViewLayers, PartsFarApartGiveThePictureOfTheWhole) {
  const VoxelMap& map = two_streets();
  std::vector<VoxelMap> parts(2, without_finest(map));
  for (std::size_t i = 0; i < 2; ++i) {
    std::vector<VoxelMap> tiles;
    for_each_tile(map, [&](const TileId& id, const VoxelMap& tile) {
      if ((id.x < 2) == (i == 0)) tiles.push_back(tile);
    });
    parts[i] = splice(tiles);
  }
  const VoxelColors colors(map, map.finest(), ColorBy::kNormal);
  const VoxelColors first(parts[0], parts[0].finest(), colors), second(parts[1], parts[1].finest(), colors);
  const Camera camera =
      Camera::orthographic(map_from_camera_at({kApart / 2, 0, 100}, 90, -90), 1.2 * kApart, {300, 100});
  const VoxelView whole = view_voxels(map.finest(), colors, camera);
  const VoxelView layers =
      view_layers(std::array{VoxelLayer{parts[0].finest(), first}, VoxelLayer{parts[1].finest(), second}}, camera);
  EXPECT_EQ(layers.distances, whole.distances);
  EXPECT_TRUE(std::ranges::equal(layers.image.pixels(), whole.image.pixels()));
}

}  // namespace
}  // namespace vdbmap
