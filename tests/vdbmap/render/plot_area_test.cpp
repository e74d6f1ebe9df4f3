// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/plot_area.h"

#include <gtest/gtest.h>

#include "tests/support/picture.h"

namespace vdbmap {
namespace {

PlotArea area_of(const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
  return {{Eigen::Vector2d(100, 50), Eigen::Vector2d(500, 250)}, {low, high}};
}

TEST(PlotArea, ValuesGrowToTheRightAndUpwards) {
  const PlotArea area = area_of({10, -1}, {20, 1});
  EXPECT_EQ(area.pixel_of({10, -1}), Eigen::Vector2d(100, 250));
  EXPECT_EQ(area.pixel_of({20, 1}), Eigen::Vector2d(500, 50));
  EXPECT_EQ(area.pixel_of({15, 0}), Eigen::Vector2d(300, 150));
}

TEST(PlotArea, EqualScaleKeepsAllValuesAndTheirMiddle) {
  for (const Eigen::Vector2d& high : {Eigen::Vector2d(10, 400), Eigen::Vector2d(400, 10)}) {
    const PlotArea area = with_equal_scale(area_of({0, 0}, high));
    const Eigen::Vector2d unit = area.pixel_of({1, 1}) - area.pixel_of({0, 0});
    EXPECT_NEAR(unit.x(), -unit.y(), 1e-12);
    EXPECT_TRUE(area.values.contains(Eigen::AlignedBox2d(Eigen::Vector2d(0, 0), high)));
    EXPECT_TRUE(area.values.center().isApprox(high / 2));
  }
}

TEST(PlotArea, StepsAreRoundNumbers) {
  EXPECT_DOUBLE_EQ(round_step(0.011), 0.02);
  EXPECT_DOUBLE_EQ(round_step(0.02), 0.02);
  EXPECT_DOUBLE_EQ(round_step(3), 5);
  EXPECT_DOUBLE_EQ(round_step(51), 100);
  EXPECT_DOUBLE_EQ(round_step(1000), 1000);
}

TEST(PlotArea, TicksAreTheMultiplesInTheRangeWithItsEnds) {
  EXPECT_EQ(ticks_between(-0.2, 0.21, 0.1).size(), 5U);
  EXPECT_DOUBLE_EQ(ticks_between(-0.2, 0.2, 0.1).back(), 0.2);
  EXPECT_EQ(ticks_between(0.31, 0.39, 0.1).size(), 0U);
}

TEST(PlotArea, NumbersHaveTheDecimalsOfTheirStep) {
  EXPECT_EQ(tick_text(0.30000000000000004, 0.1), "0.3");
  EXPECT_EQ(tick_text(-0.0, 0.5), "0.0");
  EXPECT_EQ(tick_text(550100, 50), "550100");
  EXPECT_EQ(tick_text(0.025, 0.005), "0.025");
}

TEST(PlotArea, TheFrameLiesWhereItShould) {
  Image image(600, 300);
  draw_axes(image, area_of({0, 0}, {10, 10}), {"title", "x [m]", "y [m]"});
  const Rgb8 frame = rgb8(0x404040);
  EXPECT_EQ(image.at(100, 150), frame);
  EXPECT_EQ(image.at(500, 150), frame);
  EXPECT_EQ(image.at(300, 50), frame);
  EXPECT_EQ(image.at(300, 250), frame);
  // Labels stand left of the frame and below it, the title above.
  EXPECT_LT(test::count_pixels(image, {255, 255, 255}, {Eigen::Vector2i(0, 60), Eigen::Vector2i(90, 240)}), 91U * 181U);
  EXPECT_LT(test::count_pixels(image, {255, 255, 255}, {Eigen::Vector2i(110, 275), Eigen::Vector2i(490, 299)}),
            381U * 25U);
  EXPECT_LT(test::count_pixels(image, {255, 255, 255}, {Eigen::Vector2i(110, 20), Eigen::Vector2i(490, 45)}),
            381U * 26U);
}

}  // namespace
}  // namespace vdbmap
