// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/decoration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "vdbmap/render/draw.h"
#include "vdbmap/render/plot_area.h"
#include "vdbmap/render/text.h"

namespace vdbmap {
namespace {

constexpr Rgb8 kInk = rgb8(0x1c1c1c);
constexpr Rgb8 kPaper = rgb8(0xffffff);
constexpr double kPanelOpacity = 0.78;

ImageSize size_of(const Image& image) { return {image.width(), image.height()}; }

Eigen::AlignedBox2d box(double left, double top, double right, double bottom) {
  return {Eigen::Vector2d(left, top), Eigen::Vector2d(right, bottom)};
}

TextStyle letters(const Image& image, TextAlign align = TextAlign::kLeft) {
  const int size = letter_size(size_of(image));
  return {.size = size, .ink = {kInk}, .align = align, .halo = size / 7.0};
}

void draw_grid_line(Image& image, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  draw_line(image, from, to, 1, {kInk, 0.16});
}

// A scale of colours with round numbers beside it.
void draw_color_scale(Image& image, const Eigen::AlignedBox2d& bar, const ColorLegend& legend, const TextStyle& style) {
  for (int y = static_cast<int>(bar.min().y()); y < static_cast<int>(bar.max().y()); ++y) {
    const double share = 1 - (y + 0.5 - bar.min().y()) / bar.sizes().y();
    fill_box(image, box(bar.min().x(), y, bar.max().x(), y + 1), {scale_color(share)});
  }
  draw_box(image, bar, 1, {kInk});
  const double step = round_step((legend.high - legend.low) * 1.8 * style.size / bar.sizes().y());
  for (const double value : ticks_between(legend.low, legend.high, step)) {
    const double y = bar.max().y() - (value - legend.low) / (legend.high - legend.low) * bar.sizes().y();
    draw_line(image, {bar.max().x(), y}, {bar.max().x() + 5, y}, 1.5, {kInk});
    draw_text(image, {bar.max().x() + 10, y}, tick_text(value, step), style);
  }
}

/// A name and the colour it stands for.
using Entry = std::pair<std::string, Rgb8>;

int widest(const std::vector<Entry>& entries, const TextStyle& style) {
  int width = 0;
  for (const Entry& entry : entries) width = std::max(width, text_width(entry.first, style));
  return width;
}

}  // namespace

int letter_size(const ImageSize& size) { return std::clamp(std::min(size.width, size.height) / 56, 11, 64); }

void draw_metre_grid(Image& image, const Camera& camera, const Eigen::Vector3d& anchor) {
  const double metres_per_pixel = camera.pixel_width();
  const Eigen::Vector2d half = Eigen::Vector2d(image.width(), image.height()) * metres_per_pixel / 2;
  const Eigen::Vector2d center = (camera.map_from_camera().translation() + anchor).head<2>();
  const TextStyle style = letters(image, TextAlign::kCenter);
  const double step = round_step(9 * style.size * metres_per_pixel);
  const double margin = 1.2 * style.size;
  for (const double x : ticks_between(center.x() - half.x(), center.x() + half.x(), step)) {
    const double pixel = std::floor(image.width() / 2.0 + (x - center.x()) / metres_per_pixel) + 0.5;
    draw_grid_line(image, {pixel, 0}, {pixel, image.height()});
    draw_text(image, {pixel, margin}, tick_text(x, step), style);
  }
  TextStyle vertical = style;
  vertical.is_vertical = true;
  for (const double y : ticks_between(center.y() - half.y(), center.y() + half.y(), step)) {
    const double pixel = std::floor(image.height() / 2.0 - (y - center.y()) / metres_per_pixel) + 0.5;
    draw_grid_line(image, {0, pixel}, {image.width(), pixel});
    draw_text(image, {margin, pixel}, tick_text(y, step), vertical);
  }
}

void draw_scale_bar(Image& image, double metres_per_pixel, const std::string& note) {
  const TextStyle style = letters(image);
  const double step = round_step(7 * style.size * metres_per_pixel);
  const double left = 2.0 * style.size;
  const double right = left + step / metres_per_pixel;
  const double bottom = image.height() - 1.6 * style.size;
  const double top = bottom - 0.45 * style.size;
  fill_box(image, box(left - 2, top - 2, right + 2, bottom + 2), {kPaper});
  fill_box(image, box(left, top, right, bottom), {kInk});
  fill_box(image, box((left + right) / 2, top + 1, right - 1, bottom - 1), {kPaper});
  draw_text(image, {left, top - style.size}, tick_text(step, step) + " m" + note, style);
}

void draw_north_arrow(Image& image, double heading_deg) {
  const double size = letter_size(size_of(image));
  const Eigen::Vector2d center(image.width() - 3.2 * size, 3.2 * size);
  const double turn = (heading_deg - 90) * std::numbers::pi / 180;  // of the view to the left of north
  const Eigen::Vector2d north(std::sin(turn), -std::cos(turn));
  const Eigen::Vector2d right(-north.y(), north.x());
  draw_disc(image, center, 2.4 * size, {kPaper, 0.7});
  const std::array<Eigen::Vector2d, 3> dark = {
      center + 1.3 * size * north, center - 0.55 * size * right - 1.2 * size * north, center - 0.8 * size * north};
  const std::array<Eigen::Vector2d, 3> light = {center + 1.3 * size * north, center - 0.8 * size * north,
                                                center + 0.55 * size * right - 1.2 * size * north};
  fill_polygon(image, dark, {kInk});
  fill_polygon(image, light, {rgb8(0x9a9a9a)});
  draw_text(image, center + 1.85 * size * north, "N",
            {.size = static_cast<int>(0.9 * size), .ink = {kInk}, .align = TextAlign::kCenter, .is_bold = true});
}

void draw_color_legend(Image& image, const ColorLegend& legend,
                       const std::vector<std::pair<std::string, Rgb8>>& overlays) {
  std::vector<Entry> entries = legend.entries;
  entries.insert(entries.end(), overlays.begin(), overlays.end());
  const bool has_scale = legend.high > legend.low;
  if (!has_scale && entries.empty()) return;

  TextStyle style = letters(image);
  style.halo = 0;
  const double line = 1.5 * style.size;
  const double scale_height = has_scale ? 9.0 * style.size : 0;
  const double gap = has_scale ? line : 0;
  const double title = legend.title.empty() ? 0 : line;
  const double width = std::max({static_cast<double>(text_width(legend.title, style)), 7.0 * style.size,
                                 widest(entries, style) + 2.2 * style.size});
  const double height = title + scale_height + gap + line * static_cast<double>(entries.size());
  const double right = image.width() - 1.0 * style.size;
  const double bottom = image.height() - 1.0 * style.size;
  const double pad = 0.8 * style.size;
  const double left = right - width - 2 * pad;
  fill_box(image, box(left, bottom - height - 2 * pad, right, bottom), {kPaper, kPanelOpacity});

  double y = bottom - height - pad + line / 2;
  if (title > 0) {
    draw_text(image, {left + pad, y}, legend.title, style);
    y += line;
  }
  if (has_scale) {
    const double top = std::floor(y);
    draw_color_scale(
        image,
        box(std::floor(left + pad), top, std::floor(left + pad + 1.3 * style.size), top + std::floor(scale_height)),
        legend, style);
    y += scale_height + gap;
  }
  for (const Entry& entry : entries) {
    fill_box(image, box(left + pad, y - 0.5 * style.size, left + pad + style.size, y + 0.5 * style.size),
             {entry.second});
    draw_text(image, {left + pad + 1.7 * style.size, y}, entry.first, style);
    y += line;
  }
}

}  // namespace vdbmap
