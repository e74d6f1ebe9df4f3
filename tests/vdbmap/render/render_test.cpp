// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/render.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/support/picture.h"
#include "tests/support/random_points.h"
#include "tests/support/sample_maps.h"
#include "tests/support/sanitizers.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/threads.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/render/ray_beams.h"
#include "vdbmap/render/voxel_view.h"

namespace vdbmap {
namespace {

const VoxelMap& street_map() {
  static const VoxelMap map = build_map(test::sample_scene(test::street(), test::kIsSanitized ? 20 : 100, 1));
  return map;
}

VoxelView view_of(const VoxelMap& map, const Camera& camera) {
  return view_voxels(map.finest(), VoxelColors(map, map.finest()), camera);
}

RenderOptions small(View view) {
  RenderOptions options;
  options.size = {320, 200};
  options.view = view;
  return options;
}

TEST(VoxelView, ASingleVoxelCoversThePixelsThatItShould) {
  // 2 m away, with 0.5 mrad a pixel: the near face of 10 cm appears 100 pixels wide, the far one 95.
  const VoxelMap map = test::map_of_voxels({{20, 0, 0}});
  const ImageSize size{400, 300};
  const double field_of_view_deg = 2 * std::atan(200 * 0.0005) * 180 / 3.14159265358979;
  const Eigen::Isometry3d eye = map_from_camera_at({0, 0.05, 0.05}, 0, 0);
  const VoxelView view = view_of(map, Camera::perspective(eye, field_of_view_deg, size));
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const bool is_covered = std::abs(x + 0.5 - 200) < 50 && std::abs(y + 0.5 - 150) < 50;
      ASSERT_EQ(std::isfinite(view.distance_at(x, y)), is_covered) << x << ' ' << y;
    }
  }
  EXPECT_NEAR(view.distance_at(200, 150), 2, 1e-5);
}

TEST(VoxelView, EdgesAreAntiAliased) {
  const VoxelMap map = test::map_of_voxels({{20, 0, 0}});
  const Eigen::Isometry3d eye = map_from_camera_at({0, 0.05, 0.05}, 0, 0);
  Eigen::Isometry3d rolled = eye;
  rolled.linear() = eye.linear() * Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const VoxelView view = view_of(map, Camera::perspective(rolled, 10, {400, 300}));
  const Rgb8 face = view.image.at(200, 150);
  const Rgb8 sky = view.image.at(2, 150);
  std::size_t num_between = 0;
  for (int x = 0; x < 400; ++x) {
    for (int y = 0; y < 300; ++y) {
      const Rgb8 pixel = view.image.at(x, y);
      num_between += std::min(face.r, sky.r) + 8 < pixel.r && pixel.r + 8 < std::max(face.r, sky.r) ? 1 : 0;
    }
  }
  EXPECT_GT(num_between, 200U);  // along some 1100 pixels of outline
}

TEST(VoxelView, APixelOfAPlanShowsItsPlace) {
  // A chessboard of voxels from above, ten pixels a voxel.
  std::vector<VoxelIndex> voxels;
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) {
      if ((i + j) % 2 == 0) voxels.emplace_back(i, j, (i + j) % 3);
    }
  }
  const ImageSize size{300, 300};
  const Camera camera = Camera::orthographic(map_from_camera_at({1, 1, 10}, 90, -90), 3, size);
  const VoxelView view = view_of(test::map_of_voxels(voxels), camera);
  for (int y = 0; y < 300; ++y) {
    for (int x = 0; x < 300; ++x) {
      const int i = static_cast<int>(std::floor((x + 0.5) / 10)) - 5;
      const int j = static_cast<int>(std::floor((299.5 - y) / 10)) - 5;
      const bool is_on = i >= 0 && i < 20 && j >= 0 && j < 20 && (i + j) % 2 == 0;
      ASSERT_EQ(std::isfinite(view.distance_at(x, y)), is_on) << x << ' ' << y;
      if (is_on) {
        ASSERT_NEAR(view.distance_at(x, y), 10 - 0.1 * ((i + j) % 3 + 1), 1e-5);
      }
    }
  }
}

TEST(VoxelView, BeamsHideNothing) {
  // Every pixel against the ray alone, for cameras near and far and inside.
  const VoxelMap map = test::map_of_voxels(test::random_voxels(3000, -60, 60, 7));
  const RayCaster caster(map.finest());
  std::mt19937 random(8);
  const ImageSize size{83, 61};
  for (int i = 0; i < 20; ++i) {
    Eigen::Isometry3d pose = test::random_motion(i, 70, random);
    for (const Camera& camera :
         {Camera::perspective(pose, 20 + 7 * i, size), Camera::orthographic(pose, 1 + i, size)}) {
      const VoxelView view = view_of(map, camera);
      for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
          const auto hit = caster.first_hit(camera.ray_through({x + 0.5, y + 0.5}));
          ASSERT_EQ(std::isfinite(view.distance_at(x, y)), hit.has_value()) << i << ' ' << x << ' ' << y;
          if (hit) {
            ASSERT_NEAR(view.distance_at(x, y), hit->distance, 1e-5 * (1 + hit->distance));
          }
        }
      }
    }
  }
}

TEST(VoxelView, PlacesUnderARoofAreDarkerThanOpenOnes) {
  std::vector<VoxelIndex> voxels;
  for (int i = 0; i < 120; ++i) {
    for (int j = 0; j < 40; ++j) {
      voxels.emplace_back(i, j, 0);
      if (i < 40) voxels.emplace_back(i, j, 20);
    }
  }
  const VoxelMap map = test::map_of_voxels(voxels);
  const Camera camera = Camera::perspective(map_from_camera_at({6, -6, 1.2}, 90, -8), 90, {300, 200});
  const VoxelView view = view_of(map, camera);
  const auto brightness = [&](const Eigen::Vector3d& point) {
    const Eigen::Vector2d pixel = camera.project(point)->pixel;
    const Rgb8 color = view.image.at(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
    return color.r + color.g + color.b;
  };
  EXPECT_LT(brightness({2, 2, 0.1}), 0.7 * brightness({10, 2, 0.1}));
}

class RenderViews : public testing::TestWithParam<View> {};

INSTANTIATE_TEST_SUITE_P(, RenderViews, testing::Values(View::kPlan, View::kPerspective, View::kOrbit),
                         [](const auto& view) {
                           return view.param == View::kPlan    ? "Plan"
                                  : view.param == View::kOrbit ? "Orbit"
                                                               : "Perspective";
                         });

TEST_P(RenderViews, TheChosenCameraShowsTheStreet) {
  RenderOptions options = small(GetParam());
  options.has_decoration = false;
  const Camera camera = choose_camera(street_map().finest(), GetParam(), options.size);
  const VoxelView view = view_of(street_map(), camera);
  const auto num_covered =
      std::count_if(view.distances.begin(), view.distances.end(), [](float d) { return std::isfinite(d); });
  EXPECT_GT(num_covered, 320 * 200 / 12);
}

TEST_P(RenderViews, AnyNumberOfThreadsGivesTheSamePixels) {
  RenderOverlays overlays;
  overlays.points.push_back(
      {"scan", test::random_points(500, {Eigen::Vector3d(-20, -5, 0), Eigen::Vector3d(20, 5, 3)}, 3)});
  const auto picture = [&] { return png_of(render(street_map(), small(GetParam()), overlays).image); };
  const std::string one = test::on_threads(1, picture);
  EXPECT_EQ(test::on_threads(2, picture), one);
  EXPECT_EQ(test::on_threads(5, picture), one);
}

TEST_P(RenderViews, EveryColouringThatTheMapKnowsGivesAnotherPicture) {
  const VoxelMap map = test::sample_map();
  std::vector<std::string> pictures;
  for (const ColorBy color_by :
       {ColorBy::kRgb, ColorBy::kHeight, ColorBy::kNormal, ColorBy::kIntensity, ColorBy::kEpoch}) {
    RenderOptions options = small(GetParam());
    options.color_by = color_by;
    pictures.push_back(png_of(render(map, options).image));
  }
  std::sort(pictures.begin(), pictures.end());
  EXPECT_EQ(std::unique(pictures.begin(), pictures.end()), pictures.end());
}

TEST_P(RenderViews, TinyMapsAndPicturesAreDrawn) {
  for (const ImageSize& size : {ImageSize{1, 1}, ImageSize{3, 500}, ImageSize{500, 3}}) {
    RenderOptions options = small(GetParam());
    options.size = size;
    const Image image = render(test::map_of_voxels({{5, 5, 5}}), options).image;
    EXPECT_EQ(image.width(), size.width);
    EXPECT_EQ(image.height(), size.height);
  }
}

TEST(Render, ColoursOfTheMapComeOutAsTheyWentIn) {
  // Colour of a roof in the sun; light is white but for a tint, so red stays far above green.
  PointCloud cloud;
  for (int i = 0; i < 50; ++i) {
    for (int j = 0; j < 50; ++j) {
      cloud.positions.emplace_back(0.1 * i + 0.05, 0.1 * j + 0.05, 0.05);
      cloud.colors.push_back({60000, 5000, 5000});
    }
  }
  RenderOptions options = small(View::kPlan);
  options.has_decoration = false;
  const Image image = render(build_map(cloud), options).image;
  const Rgb8 middle = image.at(160, 100);
  EXPECT_GT(middle.r, 180);
  EXPECT_LT(middle.g, 60);
}

TEST(Render, PathsLieWhereTheyShouldAndArePaleBehindVoxels) {
  // A wall across the x axis, 5 m to 5.1 m from the eye, and a path that starts before it and ends behind it.
  std::vector<VoxelIndex> voxels;
  for (int j = -40; j < 40; ++j) {
    for (int k = 0; k < 30; ++k) voxels.emplace_back(50, j, k);
  }
  RenderOverlays overlays;
  Trajectory poses;
  for (const double x : {3.0, 8.0}) {
    poses.map_from_scan.emplace_back(Eigen::Translation3d(x, 0.1 * x, 1.5) * Eigen::Isometry3d::Identity());
  }
  overlays.trajectories.push_back({"path", poses});
  RenderOptions options = small(View::kPerspective);
  options.camera = {0, 0, 1.2, 0, 0, 60};
  options.has_decoration = false;
  const VoxelMap map = test::map_of_voxels(voxels);
  const Image image = render(map, options, overlays).image;
  const Camera camera = Camera::perspective(map_from_camera_at({0, 0, 1.2}, 0, 0), 60, options.size);
  const Image without_path = render(map, options).image;
  const auto at = [&](const Image& picture, double x) {
    const Eigen::Vector2d pixel = camera.project({x, 0.1 * x, 1.5})->pixel;
    return picture.at(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
  };
  const Rgb8 red = rgb8(0xe3241f);
  EXPECT_EQ(at(image, 3), red);
  const Rgb8 wall = at(without_path, 8), behind = at(image, 8);
  // Between the wall's colour and the path's, and neither of them.
  EXPECT_GT(behind.r, wall.r + 10);
  EXPECT_LT(behind.r, red.r);
  EXPECT_LT(behind.g, wall.g - 10);
  EXPECT_GT(behind.g, red.g + 10);
}

TEST(Render, PathsOnEachOtherAreAllSeenTheFirstOnTop) {
  Trajectory poses;
  for (const double x : {-2.0, 2.0}) {
    poses.map_from_scan.emplace_back(Eigen::Translation3d(x, 0, 0.5) * Eigen::Isometry3d::Identity());
  }
  RenderOptions options = small(View::kPlan);
  options.size = {1600, 1000};  // paths are five pixels wide
  options.camera = {0, 0, 8};
  options.has_decoration = false;
  const Image image =
      render(test::map_of_voxels({{0, 0, 0}}), options, {nullptr, {}, {{"a", poses}, {"b", poses}, {"c", poses}}, {}})
          .image;
  const Rgb8 red = rgb8(0xe3241f);
  EXPECT_EQ(image.at(800, 500), red);
  const std::size_t num_red = test::count_pixels(image, red);
  const std::size_t num_green = test::count_pixels(image, rgb8(0x18a02a));
  const std::size_t num_blue = test::count_pixels(image, rgb8(0x1f5fe0));
  EXPECT_GT(num_red, 100U);
  EXPECT_GT(num_green, num_red / 2);
  EXPECT_GT(num_blue, num_red / 2);
}

TEST(Render, VoxelsHaveTheColorsOfTheirClasses) {
  PointCloud cloud;
  for (int i = -40; i < 40; ++i) {
    for (int j = -40; j < 40; ++j) {
      cloud.positions.emplace_back(0.1 * i + 0.05, 0.1 * j + 0.05, 0.05);
      cloud.labels.push_back(i < 0 ? 70 : 10);
    }
  }
  VoxelMap map = build_map(cloud);
  map.label_scheme = LabelScheme::kSemanticKitti;
  RenderOptions options = small(View::kPlan);
  options.color_by = ColorBy::kLabel;
  options.camera = {0, 0, 6};
  options.has_decoration = false;
  const Image image = render(map, options).image;
  const Rgb8 vegetation = image.at(80, 100);
  const Rgb8 car = image.at(240, 100);
  EXPECT_GT(vegetation.g, vegetation.r + 40);
  EXPECT_GT(vegetation.g, vegetation.b + 40);
  EXPECT_GT(car.b, car.r + 80);
}

TEST(Render, PointsOnASurfaceAreSeenAndThoseBehindItNot) {
  std::vector<VoxelIndex> voxels;
  for (int j = -40; j < 40; ++j) {
    for (int k = 0; k < 30; ++k) voxels.emplace_back(50, j, k);
  }
  RenderOptions options = small(View::kPerspective);
  options.camera = {0, 0, 1.2, 0, 0, 60};
  const VoxelMap map = test::map_of_voxels(voxels);
  const std::string without = png_of(render(map, options).image);
  RenderOverlays hidden;
  hidden.points.push_back({"", {{7, 0, 1.2}, {-3, 0, 1.2}}});
  options.has_decoration = false;
  EXPECT_EQ(png_of(render(map, options, hidden).image), png_of(render(map, options).image));
  RenderOverlays seen;
  seen.points.push_back({"", {{5.05, 0, 1.2}}});
  EXPECT_NE(png_of(render(map, options, seen).image), png_of(render(map, options).image));
}

TEST(Render, PlacesAreInTheOriginalSystem) {
  // The same scene at the origin and at UTM coordinates looks the same, but for the coordinates.
  const Eigen::Vector3d utm(550000, 5802000, 64);
  PointCloud here = test::sample_scene(test::box({0, 0, 0}, {3, 2, 1}), 300, 4);
  PointCloud there = here;
  for (Eigen::Vector3d& point : there.positions) point += utm;
  BuildOptions build;
  build.anchor = Eigen::Vector3d::Zero();
  const VoxelMap near = build_map(here, build);
  build.anchor = Eigen::Vector3d(549952, 5801984, 64);
  const VoxelMap far = build_map(there, build);
  RenderOptions options = small(View::kPlan);
  options.has_decoration = false;
  options.color_by = ColorBy::kNormal;
  options.camera = {1.5, 1, 8};
  const std::string at_origin = png_of(render(near, options).image);
  options.camera = {utm.x() + 1.5, utm.y() + 1, 8};
  EXPECT_EQ(png_of(render(far, options).image), at_origin);
}

TEST(Render, SparsePointsAreDrawnAtACoarserLevel) {
  // A point a metre on 200 m x 200 m: voxels of 10 cm are far smaller than a pixel, those of 1 m touch each other.
  PointCloud cloud;
  for (int i = 0; i < 200; ++i) {
    for (int j = 0; j < 200; ++j) cloud.positions.emplace_back(i + 0.5, j + 0.5, 0.05);
  }
  const VoxelMap map = build_map(cloud);
  RenderOptions options = small(View::kPlan);
  const std::string chosen = png_of(render(map, options).image);
  options.voxel_size = 1.0;
  EXPECT_EQ(png_of(render(map, options).image), chosen);
  options.voxel_size = 0.1;
  EXPECT_NE(png_of(render(map, options).image), chosen);
}

TEST(Render, ACameraInsideOfAVoxelIsNoted) {
  RenderOptions options = small(View::kPerspective);
  options.camera = {0.55, 0.55, 0.55, 0, 0};
  EXPECT_TRUE(render(test::map_of_voxels({{5, 5, 5}, {30, 5, 5}}), options).is_camera_in_voxel);
  EXPECT_FALSE(render(test::map_of_voxels({{4, 5, 5}}), options).is_camera_in_voxel);
}

TEST(Render, WhatCannotBeDrawnIsRefused) {
  const VoxelMap plain = test::sample_map_without_attributes();
  for (const ColorBy color_by : {ColorBy::kRgb, ColorBy::kIntensity, ColorBy::kEpoch, ColorBy::kLabel}) {
    RenderOptions options = small(View::kPlan);
    options.color_by = color_by;
    EXPECT_THROW(render(plain, options), std::invalid_argument);
  }
  for (const ImageSize& size : {ImageSize{0, 100}, ImageSize{100, 0}, ImageSize{100'000, 100}}) {
    RenderOptions options;
    options.size = size;
    EXPECT_THROW(render(plain, options), std::invalid_argument);
  }
  for (const std::vector<double>& camera :
       {std::vector<double>{1}, {1, 2, 3, 4, 5, 6, 7}, {0, 0, 0, 0, 91}, {0, 0, 0, 0, 0, 180}}) {
    RenderOptions options = small(View::kPerspective);
    options.camera = camera;
    EXPECT_THROW(render(plain, options), std::invalid_argument);
  }
  RenderOptions options;
  options.voxel_size = 0.3;
  EXPECT_THROW(render(plain, options), std::invalid_argument);
  EXPECT_THROW(render(build_map(PointCloud{})), std::invalid_argument);
}

}  // namespace
}  // namespace vdbmap
