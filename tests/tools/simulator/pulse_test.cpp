// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/pulse.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/tools/simulator/simple_scene.h"

namespace vdbmap::simulator {
namespace {

double share(const std::vector<double>& ranges, int count) { return static_cast<double>(ranges.size()) / count; }

TEST(Pulse, WithoutNoiseTheRangeIsTheDistance) {
  SimpleScene scene;
  add_wall_across(scene.brush(0.5F), 20, 4);
  for (const double range : ranges_along_x(scene, {}, 10)) EXPECT_NEAR(range, 20, 1e-5);
  EXPECT_EQ(ranges_along_x(scene, {}, 10).size(), 10U);
}

TEST(Pulse, RangesScatterAsTheNoiseSays) {
  SimpleScene scene;
  add_wall_across(scene.brush(0.5F), 20, 4);
  const std::vector<double> ranges = ranges_along_x(scene, {.range_noise = 0.03}, 10'000);
  const double mean = std::accumulate(ranges.begin(), ranges.end(), 0.0) / 10'000;
  double squares = 0;
  for (const double range : ranges) squares += (range - mean) * (range - mean);
  EXPECT_NEAR(mean, 20, 5 * 0.03 / 100);  // five standard deviations of the mean
  EXPECT_NEAR(std::sqrt(squares / 10'000), 0.03, 5 * 0.03 / std::sqrt(20'000));
}

TEST(Pulse, NothingComesBackFromOutsideTheLimits) {
  SimpleScene scene;
  add_wall_across(scene.brush(0.5F), 20, 4);
  EXPECT_TRUE(ranges_along_x(scene, {.farthest = 19.9}, 10).empty());
  EXPECT_TRUE(ranges_along_x(scene, {.nearest = 20.1}, 10).empty());
}

// Half of the pulses by definition at that range on 10 % reflectance, seen at a right angle.
TEST(Pulse, HalfOfThePulsesReturnFromTheHalfRange) {
  SimpleScene scene;
  add_wall_across(scene.brush(0.1F), 50, 4);
  EXPECT_NEAR(share(ranges_along_x(scene, {.half_range = 50}, 10'000), 10'000), 0.5, 5 * 0.5 / 100);
}

TEST(Pulse, DarkAndFarSurfacesLoseMoreReturns) {
  const auto returned = [](float reflectance, double distance) {
    SimpleScene scene;
    add_wall_across(scene.brush(reflectance), distance, 4);
    return share(ranges_along_x(scene, {.half_range = 50}, 4000), 4000);
  };
  EXPECT_GT(returned(0.5F, 60), returned(0.1F, 60) + 0.2);
  EXPECT_GT(returned(0.1F, 30), returned(0.1F, 60) + 0.2);
}

TEST(Pulse, GrazedSurfacesLoseMoreReturns) {
  const auto returned = [](double slant) {
    SimpleScene scene;
    add_quad(scene.brush(0.1F), {40 - slant, -1, -1}, {40 + slant, 1, -1}, {40 + slant, 1, 1}, {40 - slant, -1, 1});
    return share(ranges_along_x(scene, {.half_range = 40}, 4000), 4000);
  };
  EXPECT_GT(returned(0), returned(10) + 0.2);
}

TEST(Pulse, GlassLetsItsShareThrough) {
  SimpleScene scene;
  add_wall_across(scene.brush(0.1F, 0.75F), 10, 4);
  add_wall_across(scene.brush(0.5F), 12, 4);
  const std::vector<double> ranges = ranges_along_x(scene, {}, 10'000);
  const auto behind = std::ranges::count_if(ranges, [](double range) { return range > 11; });
  EXPECT_NEAR(static_cast<double>(behind) / 10'000, 0.75, 5 * 0.433 / 100);
}

// A beam over the edge of a wall half a metre before another.
TEST(Pulse, EdgesMixTheirTwoRangesOnlyInABeamWithWidth) {
  SimpleScene scene;
  add_quad(scene.brush(0.5F), {20, 0.001, -1}, {20, 2, -1}, {20, 2, 1}, {20, 0.001, 1});
  add_wall_across(scene.brush(0.5F), 20.5, 4);
  const auto num_between = [&](double divergence) {
    const std::vector<double> ranges = ranges_along_x(scene, {.divergence = divergence}, 4000);
    return std::ranges::count_if(ranges, [](double range) { return range > 20.02 && range < 20.48; });
  };
  EXPECT_EQ(num_between(0), 0);
  EXPECT_GT(num_between(0.003), 200);
  EXPECT_LT(num_between(0.003), 2000);
}

TEST(Pulse, SurfacesFarBehindEachOtherAreNotMixed) {
  SimpleScene scene;
  add_quad(scene.brush(0.5F), {20, 0.001, -1}, {20, 2, -1}, {20, 2, 1}, {20, 0.001, 1});
  add_wall_across(scene.brush(0.5F), 25, 4);
  for (const double range : ranges_along_x(scene, {.divergence = 0.003}, 4000)) {
    EXPECT_TRUE(std::abs(range - 20) < 0.01 || std::abs(range - 25) < 0.01) << range;
  }
}

// 12 m of rain with a chance of 0.002 a metre: one pulse in 42 measures a drop, nearer than the wall.
TEST(Pulse, RainMakesSpecksBeforeSurfaces) {
  SimpleScene scene;
  add_wall_across(scene.brush(0.5F), 20, 10);
  constexpr int kCount = 20'000;
  const std::vector<double> ranges = ranges_along_x(scene, {.specks = 0.002}, kCount);
  ASSERT_EQ(ranges.size(), static_cast<std::size_t>(kCount));
  const auto num_specks = std::ranges::count_if(ranges, [](double range) { return range < 12; });
  EXPECT_NEAR(static_cast<double>(num_specks), 0.024 * kCount, 4 * std::sqrt(0.024 * kCount));
}

}  // namespace
}  // namespace vdbmap::simulator
