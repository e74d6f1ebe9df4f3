// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/random.h"

#include <gtest/gtest.h>

namespace vdbmap::simulator {
namespace {

// Steele, Lea & Flood's generator from seed 1234567, as its reference program prints it.
TEST(Random, HashIsSplitmix64) {
  EXPECT_EQ(hash(1234567), 6457827717110365317U);
  EXPECT_EQ(hash(1234567 + 0x9e3779b97f4a7c15), 3203168211198807973U);
}

template <typename Numbers>
class RandomNumbersTest : public testing::Test {};
using BothGenerators = testing::Types<Random, RayRandom>;
TYPED_TEST_SUITE(RandomNumbersTest, BothGenerators);

// Tolerances are five standard deviations of the estimates from 100,000 numbers.
TYPED_TEST(RandomNumbersTest, HaveTheMomentsOfTheirDistributions) {
  constexpr int kCount = 100'000;
  TypeParam random(3);
  double uniform_sum = 0, normal_sum = 0, square_sum = 0;
  int num_chances = 0;
  for (int i = 0; i < kCount; ++i) {
    const double uniform = random.uniform(2, 4);
    ASSERT_GE(uniform, 2);
    ASSERT_LT(uniform, 4);
    const double normal = random.normal(10, 2);
    uniform_sum += uniform;
    normal_sum += normal;
    square_sum += (normal - 10) * (normal - 10);
    num_chances += random.chance(0.3) ? 1 : 0;
  }
  EXPECT_NEAR(uniform_sum / kCount, 3, 5 * 0.577 / 316);
  EXPECT_NEAR(normal_sum / kCount, 10, 5 * 2.0 / 316);
  EXPECT_NEAR(square_sum / kCount, 4, 5 * 4 * 1.414 / 316);
  EXPECT_NEAR(num_chances / double{kCount}, 0.3, 5 * 0.458 / 316);
}

}  // namespace
}  // namespace vdbmap::simulator
