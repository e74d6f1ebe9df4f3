// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "vdbmap/change/map_diff.h"

namespace vdbmap {

/// The colour of a kind of change in pictures and files, sRGB as in a web page: green, red, amber, and blue grey for
/// what was not observed. Green and red differ in lightness and blue too (after Okabe & Ito 2008), for those who
/// confuse them.
constexpr std::uint32_t color_code_of(Change change) {
  switch (change) {
    case Change::kAppeared:
      return 0x009e60;
    case Change::kVanished:
      return 0xd7301f;
    case Change::kChanged:
      return 0xffb000;
    case Change::kUnobserved:
      return 0x8fa3b8;
    case Change::kUnchanged:
      break;
  }
  return 0xbcbcb8;
}

}  // namespace vdbmap
