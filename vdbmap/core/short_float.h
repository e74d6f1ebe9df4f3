// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstdint>

namespace vdbmap {

/// The upper half of a float: sign, exponent and 8 significant bits ("bfloat16"). Floats that end in two zero bytes
/// take half the room in a compressed file and need no decoding by other programs.
inline float float_of_short(std::uint16_t code) { return std::bit_cast<float>(std::uint32_t{code} << 16); }

/// The code nearest to a finite value: off by at most 1/256 of it.
inline std::uint16_t short_of_float(float value) {
  return static_cast<std::uint16_t>((std::bit_cast<std::uint32_t>(value) + 0x8000u) >> 16);
}

}  // namespace vdbmap
