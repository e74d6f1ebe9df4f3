// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/points/color_range.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vdbmap {

void ColorRange::add(std::span<const double> channels) {
  for (const double channel : channels) {
    largest_ = std::max(largest_, channel);
    has_fractions_ = has_fractions_ || channel - std::floor(channel) > 0;
  }
}

double ColorRange::scale(bool are_floats) const {
  if ((are_floats || has_fractions_) && largest_ <= 1) return 65535.0;
  return largest_ <= 255 ? 257.0 : 1.0;
}

void set_color_scale(PointField& field, const ColorRange& range) {
  if (field.scale_is_known) return;
  field.scale = range.scale(!is_integer(field.type));
  field.scale_is_known = true;
}

void scale_colors(std::vector<Rgb16>& colors) {
  ColorRange range;
  for (const Rgb16& color : colors) {
    const double largest = std::max({color.r, color.g, color.b});
    range.add({&largest, 1});
  }
  const auto scale = static_cast<std::uint32_t>(range.scale(false));
  const auto scaled = [scale](std::uint16_t channel) { return static_cast<std::uint16_t>(channel * scale); };
  for (Rgb16& color : colors) color = {scaled(color.r), scaled(color.g), scaled(color.b)};
}

}  // namespace vdbmap
