// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/color_scale.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vdbmap/core/srgb.h"

namespace vdbmap {
namespace {

// Even steps of lightness up to yellow, so that heights read in grey prints too.
constexpr std::array kScale = {rgb8(0x45418e), rgb8(0x3a6ab0), rgb8(0x2f93a8), rgb8(0x48b583),
                               rgb8(0x9acb5e), rgb8(0xe8d255), rgb8(0xee9c43), rgb8(0xd9573f)};

constexpr std::array kCategories = {rgb8(0x4e79a7), rgb8(0xf28e2b), rgb8(0x59a14f), rgb8(0xe15759), rgb8(0x76b7b2),
                                    rgb8(0xedc948), rgb8(0xb07aa1), rgb8(0xff9da7), rgb8(0x9c755f), rgb8(0xbab0ac)};

constexpr int kCodes = 4096;  // linear light to 8-bit sRGB: at the steepest place a step is a quarter of a code

std::array<std::uint8_t, kCodes + 1> make_srgb_codes() {
  std::array<std::uint8_t, kCodes + 1> codes{};
  for (int i = 0; i <= kCodes; ++i) {
    codes[static_cast<std::size_t>(i)] =
        static_cast<std::uint8_t>((srgb_from_linear(static_cast<double>(i) / kCodes) + 128) / 257);
  }
  return codes;
}

std::uint8_t code_of(float linear) {
  static const std::array<std::uint8_t, kCodes + 1> codes = make_srgb_codes();
  const float clipped = linear > 0 ? std::min(linear, 1.0F) : 0.0F;  // nan becomes black
  return codes[static_cast<std::size_t>(clipped * kCodes + 0.5F)];
}

std::uint8_t between(std::uint8_t a, std::uint8_t b, double share) {
  return static_cast<std::uint8_t>(std::lround(a + (b - a) * share));
}

}  // namespace

LinearColor linear_of(Rgb8 color) {
  const auto channel = [](std::uint8_t code) {
    return static_cast<float>(linear_from_srgb(static_cast<std::uint16_t>(code * 257))) / 65535.0F;
  };
  return {channel(color.r), channel(color.g), channel(color.b)};
}

Rgb8 pixel_of(const LinearColor& color) { return {code_of(color.x()), code_of(color.y()), code_of(color.z())}; }

Rgb8 scale_color(double share) {
  const double place = (share > 0 ? std::min(share, 1.0) : 0.0) * (kScale.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(place), kScale.size() - 2);
  const double rest = place - static_cast<double>(low);
  const Rgb8 a = kScale[low];
  const Rgb8 b = kScale[low + 1];
  return {between(a.r, b.r, rest), between(a.g, b.g, rest), between(a.b, b.b, rest)};
}

Rgb8 category_color(std::size_t number) { return kCategories[number % kCategories.size()]; }

}  // namespace vdbmap
