// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

namespace vdbmap {

/// Linear light of every sRGB code (IEC 61966-2-1), both 0..65535; for loops over many points.
std::span<const std::uint16_t> linear_from_srgb_table();

/// Linear light of an sRGB code.
inline std::uint16_t linear_from_srgb(std::uint16_t srgb) { return linear_from_srgb_table()[srgb]; }

/// The sRGB code of linear light 0..1, as 0..65535.
std::uint16_t srgb_from_linear(double linear);

}  // namespace vdbmap
