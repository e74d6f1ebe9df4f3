// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/srgb.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace vdbmap {
namespace {

double linear_of_8_bits(int code) { return linear_from_srgb(static_cast<std::uint16_t>(code * 257)) / 65535.0; }

TEST(Srgb, HasTheValuesOfTheStandard) {
  // IEC 61966-2-1: 12.92 and 2.4 by hand. Half a step of 65535 is the rounding of the table.
  const double half_step = 0.5 / 65535 + 1e-9;
  EXPECT_EQ(linear_of_8_bits(0), 0);
  EXPECT_EQ(linear_of_8_bits(255), 1);
  EXPECT_NEAR(linear_of_8_bits(10), 0.003035270, half_step);  // 10/255 / 12.92: still on the straight part
  EXPECT_NEAR(linear_of_8_bits(11), 0.003346536, half_step);  // the first on the curve
  EXPECT_NEAR(linear_of_8_bits(128), 0.215860501, half_step);
  EXPECT_NEAR(linear_of_8_bits(188), 0.502886458, half_step);
  EXPECT_NEAR(srgb_from_linear(0.5) / 65535.0, 0.735356983, half_step);
  EXPECT_NEAR(srgb_from_linear(0.18) / 65535.0, 0.461356129, half_step);
}

TEST(Srgb, NeverFallsAndRisesWithEvery8BitCode) {
  for (int code = 1; code < 65536; ++code) {
    const auto last = static_cast<std::uint16_t>(code - 1);
    EXPECT_LE(linear_from_srgb(last), linear_from_srgb(static_cast<std::uint16_t>(code)));
  }
  for (int code = 1; code < 256; ++code) EXPECT_LT(linear_of_8_bits(code - 1), linear_of_8_bits(code));
}

TEST(Srgb, ComesBackToEvery8BitCode) {
  for (int code = 0; code < 256; ++code) {
    const std::uint16_t back = srgb_from_linear(linear_of_8_bits(code));
    // The straight part is 12.92 times as steep: half a step of the table becomes seven of the code, of 257.
    EXPECT_NEAR(back, code * 257, 7);
    EXPECT_EQ(std::lround(back / 257.0), code);
  }
}

TEST(Srgb, LightBeyondTheRangeIsClamped) {
  EXPECT_EQ(srgb_from_linear(-0.1), 0);
  EXPECT_EQ(srgb_from_linear(1.1), 65535);
  EXPECT_EQ(srgb_from_linear(std::numeric_limits<double>::infinity()), 65535);
}

}  // namespace
}  // namespace vdbmap
