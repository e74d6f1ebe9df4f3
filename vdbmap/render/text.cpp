// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/text.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <vector>

#include "vdbmap/core/error.h"
#include "vdbmap/render/picture_module.h"

namespace vdbmap {
namespace {

constexpr double kCapitalHeight = 0.729;  // of the font size, in DejaVu Sans

TextLine line_of(const std::string& text, const TextStyle& style) { return {text, style.size, style.is_bold}; }

TextExtent extent_of(const std::string& text, const TextStyle& style) {
  TextExtent extent;
  if (!picture_module().measure_text(line_of(text, style), extent)) {
    throw IoError::system("DejaVuSans.ttf", "cannot find the font", ENOENT);
  }
  return extent;
}

/// How much of each pixel the letters cover.
struct Letters {
  int left;  ///< of the first pixel, seen from the left end of the baseline
  int top;
  int width;
  int height;
  std::vector<float> coverage;

  float at(int x, int y) const {
    if (x < 0 || y < 0 || x >= width || y >= height) return 0;
    return coverage[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

Letters letters_of(const std::string& text, const TextStyle& style) {
  constexpr int kMargin = 2;  // [pixels] for what reaches beyond the extent by rounding
  TextExtent around = extent_of(text, style);
  around = {around.left - kMargin, around.top - kMargin, around.right + kMargin, around.bottom + kMargin};
  Letters letters{around.left, around.top, around.right - around.left, around.bottom - around.top, {}};
  letters.coverage.resize(static_cast<std::size_t>(letters.width) * static_cast<std::size_t>(letters.height));
  picture_module().cover_text(line_of(text, style), around, letters.coverage.data());
  return letters;
}

// A quarter turn to the left: right becomes up.
Letters turned(const Letters& letters) {
  Letters result{letters.top, -letters.left - letters.width, letters.height, letters.width, {}};
  result.coverage.reserve(letters.coverage.size());
  for (int y = 0; y < result.height; ++y) {
    for (int x = 0; x < result.width; ++x) result.coverage.push_back(letters.at(letters.width - 1 - y, x));
  }
  return result;
}

// The nearest letter's coverage, less what a disc of that radius leaves free.
float halo_at(const Letters& letters, int x, int y, double radius) {
  const int reach = static_cast<int>(std::ceil(radius));
  float coverage = 0;
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const auto within = static_cast<float>(std::clamp(radius + 0.5 - std::hypot(dx, dy), 0.0, 1.0));
      coverage = std::max(coverage, within * letters.at(x + dx, y + dy));
    }
  }
  return coverage;
}

void draw_halo(Image& image, const Letters& letters, int left, int top, const TextStyle& style) {
  const int reach = static_cast<int>(std::ceil(style.halo));
  for (int y = -reach; y < letters.height + reach; ++y) {
    for (int x = -reach; x < letters.width + reach; ++x) {
      image.blend(left + x, top + y, style.halo_color, style.ink.opacity * halo_at(letters, x, y, style.halo));
    }
  }
}

// From the place of a text to the left end of its baseline.
Eigen::Vector2d shift_to_baseline(const std::string& text, const TextStyle& style) {
  const double width = text_width(text, style);
  const double back = style.align == TextAlign::kLeft ? 0 : style.align == TextAlign::kCenter ? width / 2 : width;
  const double down = kCapitalHeight * style.size / 2;
  return style.is_vertical ? Eigen::Vector2d(down, back) : Eigen::Vector2d(-back, down);
}

}  // namespace

void draw_text(Image& image, const Eigen::Vector2d& place, const std::string& text, const TextStyle& style) {
  if (text.empty() || !place.allFinite()) return;
  const Letters flat = letters_of(text, style);
  const Letters letters = style.is_vertical ? turned(flat) : flat;
  const Eigen::Vector2d baseline = place + shift_to_baseline(text, style);
  const int left = static_cast<int>(std::lround(baseline.x())) + letters.left;
  const int top = static_cast<int>(std::lround(baseline.y())) + letters.top;
  if (style.halo > 0) draw_halo(image, letters, left, top, style);
  for (int y = 0; y < letters.height; ++y) {
    for (int x = 0; x < letters.width; ++x) {
      image.blend(left + x, top + y, style.ink.color, style.ink.opacity * letters.at(x, y));
    }
  }
}

int text_width(const std::string& text, const TextStyle& style) {
  return text.empty() ? 0 : extent_of(text, style).right;
}

}  // namespace vdbmap
