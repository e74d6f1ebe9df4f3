// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/plot_area.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "vdbmap/render/draw.h"
#include "vdbmap/render/text.h"

namespace vdbmap {
namespace {

constexpr Rgb8 kFrameColor = rgb8(0x404040);
constexpr Rgb8 kGridColor = rgb8(0xe4e4e4);
constexpr Rgb8 kTextColor = rgb8(0x202020);
constexpr double kTickLength = 5;      // [pixels]
constexpr double kPixelsPerTick = 70;  // [pixels] at least from number to number
constexpr int kNumberSize = 14;        // [pixels]
constexpr int kLabelSize = 15;
constexpr int kTitleSize = 17;

// Lines one pixel wide are sharp on the middle of a pixel.
double sharp(double pixel) { return std::floor(pixel) + 0.5; }

double tick_step(double values, double pixels) { return round_step(values * kPixelsPerTick / std::max(pixels, 1.0)); }

void draw_x_axis(Image& image, const PlotArea& area) {
  const double step = tick_step(area.values.sizes().x(), area.frame.sizes().x());
  const double bottom = sharp(area.frame.max().y());
  for (const double value : ticks_between(area.values.min().x(), area.values.max().x(), step)) {
    const double x = sharp(area.pixel_of({value, 0}).x());
    draw_line(image, {x, area.frame.min().y()}, {x, bottom}, 1, {kGridColor});
    draw_line(image, {x, bottom}, {x, bottom + kTickLength}, 1, {kFrameColor});
    draw_text(image, {x, bottom + 15}, tick_text(value, step),
              {.size = kNumberSize, .ink = {kTextColor}, .align = TextAlign::kCenter});
  }
}

void draw_y_axis(Image& image, const PlotArea& area) {
  // Numbers stand above each other, so that ticks may be closer.
  const double step = tick_step(area.values.sizes().y(), 1.6 * area.frame.sizes().y());
  const double left = sharp(area.frame.min().x());
  for (const double value : ticks_between(area.values.min().y(), area.values.max().y(), step)) {
    const double y = sharp(area.pixel_of({0, value}).y());
    draw_line(image, {left, y}, {area.frame.max().x(), y}, 1, {kGridColor});
    draw_line(image, {left - kTickLength, y}, {left, y}, 1, {kFrameColor});
    draw_text(image, {left - kTickLength - 4, y}, tick_text(value, step),
              {.size = kNumberSize, .ink = {kTextColor}, .align = TextAlign::kRight});
  }
}

void draw_labels(Image& image, const Eigen::AlignedBox2d& frame, const AxisLabels& labels) {
  const TextStyle label{.size = kLabelSize, .ink = {kTextColor}, .align = TextAlign::kCenter};
  TextStyle vertical = label;
  vertical.is_vertical = true;
  draw_text(image, {frame.center().x(), frame.max().y() + 38}, labels.x, label);
  draw_text(image, {frame.min().x() - 76, frame.center().y()}, labels.y, vertical);
  draw_text(image, {frame.min().x(), frame.min().y() - 17}, labels.title,
            {.size = kTitleSize, .ink = {kTextColor}, .is_bold = true});
}

}  // namespace

Eigen::Vector2d PlotArea::pixel_of(const Eigen::Vector2d& value) const {
  const Eigen::Array2d share = (value - values.min()).array() / values.sizes().array();
  return {frame.min().x() + share.x() * frame.sizes().x(), frame.max().y() - share.y() * frame.sizes().y()};
}

PlotArea with_equal_scale(PlotArea area) {
  const Eigen::Vector2d pixels = area.frame.sizes();
  const Eigen::Vector2d center = area.values.center();
  const double units_per_pixel = (area.values.sizes().array() / pixels.array()).maxCoeff();
  area.values = {center - pixels * (units_per_pixel / 2), center + pixels * (units_per_pixel / 2)};
  return area;
}

double round_step(double least) {
  const double decade = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= least * (1 - 1e-9)) return factor * decade;
  }
  return 10 * decade;
}

std::vector<double> ticks_between(double low, double high, double step) {
  std::vector<double> ticks;
  const double slack = 1e-9;  // a bound that is a multiple but for rounding belongs to the range
  const double last = std::floor(high / step + slack);
  for (double i = std::ceil(low / step - slack); i <= last; ++i) ticks.push_back(i * step);
  return ticks;
}

std::string tick_text(double value, double step) {
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value == 0 ? 0.0 : value);
  return text;
}

void draw_axes(Image& image, const PlotArea& area, const AxisLabels& labels) {
  draw_x_axis(image, area);
  draw_y_axis(image, area);
  Eigen::AlignedBox2d outline(Eigen::Vector2d(sharp(area.frame.min().x()), sharp(area.frame.min().y())),
                              Eigen::Vector2d(sharp(area.frame.max().x()), sharp(area.frame.max().y())));
  draw_box(image, outline, 1, {kFrameColor});
  draw_labels(image, area.frame, labels);
}

}  // namespace vdbmap
