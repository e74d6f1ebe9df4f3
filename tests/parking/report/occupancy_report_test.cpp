// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/report/occupancy_report.h"

#include <algorithm>
#include <stdexcept>

#include <gtest/gtest.h>

#include "parking/report/space_drawing.h"
#include "parking/report/street_scene.h"
#include "tests/support/labelled_street.h"
#include "tests/support/threads.h"

namespace vdbmap::parking {
namespace {

using test::LabelledStreet;

// A row of spaces along x on level ground.
OccupancyRecord row(std::size_t count, double pitch = 6) {
  OccupancyRecord record;
  record.place = "Row";
  record.map_name = "row";
  for (std::size_t i = 0; i < count; ++i) {
    const double x = pitch * static_cast<double>(i);
    record.spaces.push_back(space_of_outline({{x, 0}, {x + 5, 0}, {x + 5, 2}, {x, 2}}));
    record.spaces.back().id = std::to_string(i + 1);
    record.spaces.back().ground = 0.03;
    SpaceOccupancy state;
    state.state = static_cast<SpaceState>(i % 3);
    record.states.push_back(state);
  }
  return record;
}

VoxelMap ground_map(double length) {
  LabelledStreet street;
  street.add_patch({-6, -4, 0.03}, {length + 12, 10}, SurfaceClass::kGround);
  return street.map();
}

VoxelMap no_map() {
  VoxelMap map;
  map.levels.emplace_back(0.1, LargeVector<VoxelLeaf>{}, LargeVector<VoxelRecord>{});
  return map;
}

double share_of_color(const Image& image, Rgb8 color) {
  return static_cast<double>(std::ranges::count(image.pixels(), color)) /
         static_cast<double>(image.width() * image.height());
}

TEST(OccupancyReport, HasMorePagesForALongStreet) {
  const VoxelMap map = ground_map(40);
  const GroundPlan ground(map.finest());
  const std::vector<Image> pages = draw_report(row(6), map, no_map(), ground);
  ASSERT_EQ(pages.size(), 3U);  // overview, one section, table
  for (const Image& page : pages) {
    EXPECT_EQ(page.width(), 2480);
    EXPECT_EQ(page.height(), 1754);
  }
  EXPECT_EQ(draw_report(row(100, 6), map, no_map(), ground).size(), 1U + 4U + 2U);
}

TEST(OccupancyReport, ShowsStatesInTheirColors) {
  const VoxelMap map = ground_map(40);
  const GroundPlan ground(map.finest());
  OccupancyRecord record = row(6);
  const auto shares = [&] {
    const Image page = draw_report(record, map, no_map(), ground).at(1);
    return std::pair(share_of_color(page, color_of(SpaceState::kOccupied)),
                     share_of_color(page, color_of(SpaceState::kVacant)));
  };
  for (SpaceOccupancy& state : record.states) state.state = SpaceState::kOccupied;
  const auto all_taken = shares();
  for (SpaceOccupancy& state : record.states) state.state = SpaceState::kVacant;
  const auto all_free = shares();
  EXPECT_GT(all_taken.first, 3 * all_free.first);
  EXPECT_GT(all_free.second, 3 * all_taken.second);
}

// A pixel in the middle of a space, beside its id, is its state's colour over that of the ground.
TEST(OccupancyReport, DrawsSpacesWhereTheyAre) {
  const VoxelMap map = ground_map(40);
  const GroundPlan ground(map.finest());
  OccupancyRecord record = row(3);
  const VoxelMap scene = street_scene(map, no_map(), ground, record.spaces);
  const VoxelColors colors(scene, scene.finest(), ColorBy::kRgb);
  const StreetFrame frame = street_frame(record.spaces);
  const ImageSize size{800, 400};  // 20 pixels a metre
  const auto pixel_at = [&](const Eigen::Vector2d& place) {
    const Image image = draw_plan(record, scene.finest(), colors, frame, {8.5, 1}, 40, size);
    return image.at(static_cast<int>(400 + 20 * (place.x() - 8.5)), static_cast<int>(200 - 20 * (place.y() - 1)));
  };
  record.states[0].state = SpaceState::kOccupied;
  record.states[1].state = SpaceState::kVacant;
  const Rgb8 red = pixel_at({1, 0.5}), green = pixel_at({7, 0.5}), road = pixel_at({5.5, 0.5});
  EXPECT_GT(red.r, red.g + 40);
  EXPECT_GT(green.g, green.r + 20);
  EXPECT_LT(std::abs(road.r - road.g), 10);
}

TEST(OccupancyReport, ShowsTheVehiclesOfTheLaterEpoch) {
  LabelledStreet before, now;
  before.add_patch({-6, -4, 0.03}, {40, 10}, SurfaceClass::kGround);
  before.add_body({2.5, 1}, 0);
  now.add_body({8.5, 1}, 0);
  now.add_body({8.5, 20}, 0);  // in no space
  for (double z = 0.1; z < 6; z += 0.08) before.add({15, 5, z}, SurfaceClass::kPole);
  const VoxelMap map = before.map(), later = now.map();
  const OccupancyRecord record = row(3);
  const VoxelMap scene = street_scene(map, later, GroundPlan(map.finest()), record.spaces);
  const VoxelFinder finder(scene.finest());
  const auto is_there = [&](const Eigen::Vector3d& place) { return finder.find(voxel_of_point(place, 10)) != nullptr; };
  EXPECT_FALSE(is_there({2.5, 1, 1.39}));
  EXPECT_TRUE(is_there({8.5, 1, 1.39}));
  EXPECT_FALSE(is_there({8.5, 20, 1.39}));
  EXPECT_TRUE(is_there({15, 5, 2.02}));
  EXPECT_FALSE(is_there({15, 5, 5.02}));
}

TEST(OccupancyReport, HasTheSamePixelsForAnyNumberOfThreads) {
  const VoxelMap map = ground_map(20);
  const GroundPlan ground(map.finest());
  const auto pixels = [&] {
    const std::vector<Image> pages = draw_report(row(3), map, no_map(), ground);
    return std::vector<Rgb8>(pages[0].pixels().begin(), pages[0].pixels().end());
  };
  const std::vector<Rgb8> on_all = pixels();
  const ThreadLimit one(1);
  EXPECT_EQ(pixels(), on_all);
}

TEST(OccupancyReport, NeedsSpaces) {
  const VoxelMap map = ground_map(20);
  EXPECT_THROW(draw_report({}, map, no_map(), GroundPlan(map.finest())), std::invalid_argument);
}

}  // namespace
}  // namespace vdbmap::parking
