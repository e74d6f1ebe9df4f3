// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/label_colors.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace vdbmap {
namespace {

using LabelColor = std::pair<std::int32_t, Rgb8>;

constexpr Rgb8 kNoClass = rgb8(0xb9b9b9);

constexpr Rgb8 kAsphalt = rgb8(0x5d606b);
constexpr Rgb8 kBareGround = rgb8(0xa8835a);
constexpr Rgb8 kMasonry = rgb8(0xc98f66);
constexpr Rgb8 kLeaves = rgb8(0x3f9142);
constexpr Rgb8 kGrass = rgb8(0x9cc25a);
constexpr Rgb8 kMast = rgb8(0xf2d13d);
constexpr Rgb8 kNoise = rgb8(0xd94f9b);
constexpr Rgb8 kCar = rgb8(0x2f7de1);
constexpr Rgb8 kTruck = rgb8(0x1f4fa3);
constexpr Rgb8 kTwoWheeler = rgb8(0x3cc0d6);
constexpr Rgb8 kPerson = rgb8(0xe0312e);
constexpr Rgb8 kRider = rgb8(0xe8508a);

constexpr auto kAsprsColors = std::to_array<LabelColor>({
    {1, rgb8(0x8f8f8f)},  {2, kBareGround},     {3, rgb8(0xb5d67a)},  {4, rgb8(0x76b34e)},  {5, kLeaves},
    {6, kMasonry},        {7, kNoise},          {8, rgb8(0xc9a679)},  {9, rgb8(0x4a90d9)},  {10, rgb8(0x7d6b91)},
    {11, kAsphalt},       {12, rgb8(0xc7c7a3)}, {13, kMast},          {14, rgb8(0xffe680)}, {15, rgb8(0xc9a227)},
    {16, rgb8(0xe0b93a)}, {17, rgb8(0x9a8f80)}, {18, rgb8(0xb03a80)}, {19, rgb8(0xb58ad6)}, {20, rgb8(0x8a6b48)},
    {21, rgb8(0xeef4f8)}, {22, rgb8(0x6f8f8f)},
});

constexpr auto kSemanticKittiColors = std::to_array<LabelColor>({
    {1, kNoise},           {10, kCar},
    {11, kTwoWheeler},     {13, rgb8(0x16397a)},
    {15, rgb8(0x2a9aa8)},  {16, rgb8(0x7d6b91)},
    {18, kTruck},          {20, rgb8(0x7fb2f0)},
    {30, kPerson},         {31, kRider},
    {32, rgb8(0xb52d6f)},  {40, kAsphalt},
    {44, rgb8(0xb08fd0)},  {48, rgb8(0xd6c6ab)},
    {49, rgb8(0x9a8f80)},  {50, kMasonry},
    {51, rgb8(0x8f4a2a)},  {52, rgb8(0xc7a27c)},
    {60, rgb8(0xf4f4ec)},  {70, kLeaves},
    {71, rgb8(0x6b4423)},  {72, kGrass},
    {80, kMast},           {81, rgb8(0xff9f1c)},
    {99, rgb8(0xa5589f)},  {252, rgb8(0x66a6ff)},
    {253, rgb8(0xff7fb0)}, {254, rgb8(0xff6b61)},
    {255, rgb8(0xd45a95)}, {256, rgb8(0xa391b8)},
    {257, rgb8(0x3b63b5)}, {258, rgb8(0x4a7ad0)},
    {259, rgb8(0xa8cdf7)},
});

std::span<const LabelColor> colors_of(LabelScheme scheme) {
  if (scheme == LabelScheme::kAsprs) return kAsprsColors;
  if (scheme == LabelScheme::kSemanticKitti) return kSemanticKittiColors;
  return {};
}

// A colour of its own for each number, neither dark nor pale; multiples of ten, as many schemes have them, differ too.
Rgb8 mixed_color(std::uint32_t number) {
  std::uint32_t bits = number * 0x9e3779b1u;
  bits = (bits ^ bits >> 15) * 0x85ebca6bu;
  bits ^= bits >> 13;
  const auto channel = [&](int shift) {
    return static_cast<std::uint8_t>(0x30 + (bits >> shift & 0xff) * 0xb0 / 0xff);
  };
  return {channel(0), channel(8), channel(16)};
}

}  // namespace

Rgb8 label_color(LabelScheme scheme, std::int32_t label) {
  if (label == kNoLabel) return kNoClass;
  const std::span<const LabelColor> colors = colors_of(scheme);
  const auto found = std::ranges::find(colors, label, &LabelColor::first);
  return found == colors.end() ? mixed_color(static_cast<std::uint32_t>(label)) : found->second;
}

}  // namespace vdbmap
