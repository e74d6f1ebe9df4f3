// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace vdbmap {

/// Linear light of an sRGB code (IEC 61966-2-1), both 0..65535.
std::uint16_t linear_from_srgb(std::uint16_t srgb);

/// The sRGB code of linear light 0..1, as 0..65535.
std::uint16_t srgb_from_linear(double linear);

}  // namespace vdbmap
