// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel_sums.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace vdbmap {
namespace {

float mean_of(std::initializer_list<double> intensities) {
  VoxelSums sums;
  for (const double intensity : intensities) add_intensity(sums, intensity);
  return intensity_of(sums);
}

TEST(VoxelSums, IntensitiesOfAnySizeThatSensorsGiveAreAveraged) {
  EXPECT_EQ(mean_of({16777216.0}), 16777216.0F);
  EXPECT_EQ(mean_of({1e8}), 1e8F);
  EXPECT_EQ(mean_of({4294967296.0, 0}), 2147483648.0F);
  EXPECT_EQ(mean_of({-0.25, 0.75}), 0.25F);
  EXPECT_EQ(mean_of({kLargestIntensity, -kLargestIntensity, 3}), 1.0F);
}

TEST(VoxelSums, IntensitiesThatAreNoneDoNotCount) {
  EXPECT_EQ(mean_of({NAN, 3, 1e30, -std::numeric_limits<double>::infinity()}), 3.0F);
  EXPECT_EQ(mean_of({NAN}), 0.0F);
}

TEST(VoxelSums, SumsOfManyLargeIntensitiesDoNotOverflow) {
  VoxelSums sums;
  for (int i = 0; i < 1000; ++i) add_intensity(sums, i % 4 == 0 ? -kLargestIntensity : kLargestIntensity);
  for (int doubling = 0; doubling < 20; ++doubling) sums.add(VoxelSums(sums));  // 1e9 points
  EXPECT_EQ(intensity_of(sums), static_cast<float>(kLargestIntensity / 2));
}

}  // namespace
}  // namespace vdbmap
