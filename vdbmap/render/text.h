// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <Eigen/Core>

#include "vdbmap/render/draw.h"

namespace vdbmap {

/// Which point along a text lies at its place.
enum class TextAlign { kLeft, kCenter, kRight };

struct TextStyle {
  int size = 16;  ///< [pixels] of the font
  Ink ink{{0, 0, 0}};
  TextAlign align = TextAlign::kLeft;
  bool is_bold = false;
  bool is_vertical = false;  ///< reads from below
  double halo = 0;           ///< [pixels] of a rim in `halo_color`, which keeps it legible on anything
  Rgb8 halo_color{255, 255, 255};
};

/// Letters one line of ASCII in DejaVu Sans, across its direction centred on its capitals. Throws IoError where the
/// font is missing.
void draw_text(Image& image, const Eigen::Vector2d& place, const std::string& text, const TextStyle& style = {});

/// Width of the line [pixels].
int text_width(const std::string& text, const TextStyle& style = {});

}  // namespace vdbmap
