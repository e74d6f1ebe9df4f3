// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/draw.h"

#include <array>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/picture.h"
#include "vdbmap/render/text.h"

namespace vdbmap {
namespace {

constexpr Rgb8 kWhite{255, 255, 255};
constexpr Rgb8 kBlack{0, 0, 0};

// Black on white: how many pixels are covered, partly covered ones in part.
double area_of_black(const Image& image) {
  double area = 0;
  for (const Rgb8& pixel : image.pixels()) area += (255 - pixel.r) / 255.0;
  return area;
}

double area_of_white(const Image& image) { return static_cast<double>(image.pixels().size()) - area_of_black(image); }

double area_drawn(const std::function<void(Image&)>& draw) {
  Image image(200, 200);
  draw(image);
  return area_of_black(image);
}

TEST(Draw, ShapesCoverTheirArea) {
  // Pixels at the rim are covered by their distance to it, good to a hundredth for radii and widths of some pixels.
  EXPECT_NEAR(area_drawn([](Image& image) {
                draw_disc(image, {100.3, 99.6}, 30, {kBlack});
              }),
              std::numbers::pi * 900, 30);
  EXPECT_NEAR(area_drawn([](Image& image) {
                draw_ring(image, {100.3, 99.6}, 30, 4, {kBlack});
              }),
              2 * std::numbers::pi * 30 * 4, 8);
  EXPECT_NEAR(area_drawn([](Image& image) {
                draw_line(image, {20, 30}, {140, 120}, 6, {kBlack});
              }),
              150 * 6 + std::numbers::pi * 9, 10);
  EXPECT_NEAR(area_drawn([](Image& image) {
                fill_polygon(image, std::array<Eigen::Vector2d, 3>{{{20, 20}, {150, 40}, {60, 170}}}, {kBlack});
              }),
              9350, 94);
  EXPECT_NEAR(area_drawn([](Image& image) {
                fill_box(image, {Eigen::Vector2d(10.25, 20.5), Eigen::Vector2d(50.75, 21.5)}, {kBlack});
              }),
              40.5, 0.2);
  EXPECT_NEAR(area_drawn([](Image& image) {
                draw_box(image, {Eigen::Vector2d(10, 20), Eigen::Vector2d(60, 50)}, 2, {kBlack});
              }),
              52 * 32 - 48 * 28, 0.2);
}

TEST(Draw, ALineOfOnePixelOnPixelMiddlesIsSharp) {
  Image image(20, 10);
  draw_line(image, {5.5, 4.5}, {14.5, 4.5}, 1, {kBlack});
  EXPECT_EQ(test::count_pixels(image, kBlack), 10U);
  for (int x = 5; x < 15; ++x) EXPECT_EQ(image.at(x, 4), kBlack);
}

TEST(Draw, JointsOfATransparentPolylineAreNotDarker) {
  Image image(100, 100);
  draw_polyline(image, std::array<Eigen::Vector2d, 3>{{{10, 10}, {50, 50}, {10, 90}}}, 9, {kBlack, 0.5});
  EXPECT_EQ(image.at(49, 50), image.at(30, 30));
}

TEST(Draw, ThinLinesGetPaler) {
  const double one = area_drawn([](Image& image) { draw_line(image, {20, 30}, {140, 120}, 1, {kBlack}); });
  const double half = area_drawn([](Image& image) { draw_line(image, {20, 30}, {140, 120}, 0.5, {kBlack}); });
  EXPECT_NEAR(half / one, 0.5, 0.01);
}

TEST(Draw, WhatLiesOutsideIsCutOff) {
  Image inside(100, 100);
  draw_line(inside, {-1e9, 50.5}, {1e9, 50.5}, 3, {kBlack});
  EXPECT_EQ(test::count_pixels(inside, kBlack), 300U);
  draw_disc(inside, {1e12, -1e12}, 5, {kBlack});
  draw_text(inside, {-4000, 50}, "far away");
  EXPECT_EQ(test::count_pixels(inside, kBlack), 300U);
}

TEST(Draw, SlantingLinesAreTheSameCutOffOrWhole) {
  Image whole(300, 300);
  Image part(100, 100);
  draw_line(whole, {10, 20}, {250, 290}, 5, {kBlack});
  draw_line(part, {-90, -80}, {150, 190}, 5, {kBlack});
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 100; ++x) ASSERT_EQ(part.at(x, y), whole.at(x + 100, y + 100)) << x << ' ' << y;
  }
}

TEST(Draw, WhatIsNotFiniteIsLeftOut) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(area_drawn([&](Image& image) {
              draw_disc(image, {nan, 5}, 5, {kBlack});
              draw_line(image, {nan, 5}, {nan, 7}, 5, {kBlack});
              draw_text(image, {5, infinity}, "text");
              fill_box(image, {Eigen::Vector2d(nan, 0), Eigen::Vector2d(5, 5)}, {kBlack});
            }),
            0);
  Image image(100, 100);
  draw_polyline(image, std::array<Eigen::Vector2d, 3>{{{10.5, 10.5}, {infinity, 50}, {10.5, 20.5}}}, 1, {kBlack});
  EXPECT_EQ(test::count_pixels(image, kBlack), 11U);
}

TEST(Draw, ClippingCopiesWholePixelsOfTheBoxOnly) {
  Image target(10, 10);
  copy_box(target, Image(10, 10, kBlack), {Eigen::Vector2d(1.5, 2), Eigen::Vector2d(5, 6.9)});
  EXPECT_EQ(test::count_pixels(target, kBlack), 3U * 4U);
  EXPECT_EQ(target.at(2, 2), kBlack);
  EXPECT_EQ(target.at(1, 2), kWhite);
}

// Columns or rows of the first and last pixel that is not white.
struct Bounds {
  int left = 1000, right = -1, top = 1000, bottom = -1;
};

Bounds bounds_of(const Image& image) {
  Bounds bounds;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (image.at(x, y) == kWhite) continue;
      bounds = {std::min(bounds.left, x), std::max(bounds.right, x), std::min(bounds.top, y),
                std::max(bounds.bottom, y)};
    }
  }
  return bounds;
}

TEST(DrawText, CapitalsAreCentredOnTheirPlaceInEitherDirection) {
  for (const bool is_vertical : {false, true}) {
    Image image(300, 300);
    draw_text(image, {150, 150}, "HHHHHHHH", {.size = 20, .align = TextAlign::kCenter, .is_vertical = is_vertical});
    const Bounds bounds = bounds_of(image);
    EXPECT_NEAR((bounds.left + bounds.right + 1) / 2.0, 150, 1.5);
    EXPECT_NEAR((bounds.top + bounds.bottom + 1) / 2.0, 150, 1.5);
    // DejaVu's capitals are 0.73 of the font size high.
    const int height = is_vertical ? bounds.right - bounds.left + 1 : bounds.bottom - bounds.top + 1;
    EXPECT_NEAR(height, 0.73 * 20, 1.1);
  }
}

TEST(DrawText, AlignsByTheWidthOfTheLine) {
  const TextStyle right{.align = TextAlign::kRight};
  const int width = text_width("8888 m", right);
  Image image(300, 60);
  draw_text(image, {250, 30}, "8888 m", right);
  const Bounds bounds = bounds_of(image);
  EXPECT_LE(bounds.right, 250);
  EXPECT_NEAR(bounds.left, 250 - width, 2);
}

TEST(DrawText, AHaloSurroundsTheLetters) {
  const TextStyle plain{.size = 30, .align = TextAlign::kCenter};
  TextStyle rimmed = plain;
  rimmed.halo = 2;
  Image image(200, 60, kBlack);
  draw_text(image, {100, 30}, "scale", plain);
  EXPECT_EQ(test::count_pixels(image, kBlack), 200U * 60U);
  draw_text(image, {100, 30}, "scale", rimmed);
  EXPECT_GT(area_of_white(image), 300);  // five letters with an outline of some 60 pixels, 2 wide
}

}  // namespace
}  // namespace vdbmap
