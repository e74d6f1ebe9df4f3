// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/srgb.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vdbmap {
namespace {

constexpr double kCodeMax = 65535.0;

double decode(double srgb) { return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4); }

double encode(double linear) {
  return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

std::vector<std::uint16_t> make_table() {
  std::vector<std::uint16_t> table(65536);
  for (std::size_t i = 0; i < table.size(); ++i) {
    table[i] = static_cast<std::uint16_t>(std::lround(decode(static_cast<double>(i) / kCodeMax) * kCodeMax));
  }
  return table;
}

}  // namespace

std::span<const std::uint16_t> linear_from_srgb_table() {
  static const std::vector<std::uint16_t> table = make_table();
  return table;
}

std::uint16_t srgb_from_linear(double linear) {
  return static_cast<std::uint16_t>(std::lround(encode(std::clamp(linear, 0.0, 1.0)) * kCodeMax));
}

}  // namespace vdbmap
