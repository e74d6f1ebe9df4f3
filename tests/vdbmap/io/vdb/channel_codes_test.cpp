// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vdb/channel_codes.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace vdbmap {
namespace {

constexpr int kSignOfZ = 0x2000;

TEST(ChannelCodes, EveryMeanCodeComesBackAtEveryVoxelSize) {
  for (const double size : {0.001, 0.05, 0.1, 0.5, 1.0, 64.0}) {
    for (int code = 0; code < kMeanSteps; ++code) {
      VoxelRecord record;
      record.mean_code = {static_cast<std::uint16_t>(code), static_cast<std::uint16_t>(kMeanSteps - 1 - code), 0};
      VoxelRecord read;
      set_mean_offset(read, mean_offset_of(record, size), size);
      ASSERT_EQ(read.mean_code, record.mean_code) << size << " m";
    }
  }
}

TEST(ChannelCodes, MeansBeyondTheVoxelStopAtItsBorder) {
  VoxelRecord record;
  set_mean_offset(record, {-7, 0, 7}, 0.1);
  EXPECT_EQ(record.mean_code, (std::array<std::uint16_t, 3>{0, kMeanSteps / 2, kMeanSteps - 1}));
}

TEST(ChannelCodes, EveryColorCodeComesBack) {
  constexpr int kWhite = 0x3f80;  // upper half of 1.0f
  for (int code = 0; code <= kWhite; ++code) {
    VoxelRecord record;
    record.color_code = {static_cast<std::uint16_t>(code), static_cast<std::uint16_t>(kWhite - code), 0};
    VoxelRecord read;
    set_color_value(read, color_value_of(record));
    ASSERT_EQ(read.color_code, record.color_code);
  }
}

TEST(ChannelCodes, EveryPlanarityCodeComesBack) {
  for (int code = 0; code <= 255; ++code) {
    VoxelRecord record;
    record.planarity_code = static_cast<std::uint8_t>(code);
    VoxelRecord read;
    set_planarity_value(read, planarity_value_of(record));
    ASSERT_EQ(read.planarity_code, record.planarity_code);
  }
}

TEST(ChannelCodes, EveryNormalCodeOfTheUpperHalfComesBack) {
  int num_codes = 0;
  for (int code = 0; code <= 65535; ++code) {
    VoxelRecord record;
    record.normal_code = static_cast<std::uint16_t>(code);
    const float z = normal_value_of(record).z();
    const bool is_lower_half = z < 0 || (z > 0 && (code & kSignOfZ));  // the latter codes nobody writes
    if (is_lower_half) continue;
    VoxelRecord read;
    set_normal_value(read, normal_value_of(record));
    ASSERT_EQ(read.normal_code, record.normal_code) << normal_value_of(record);
    ++num_codes;
  }
  // 127 * 128 / 2 pairs of |x| and |y| with two signs, and 127 of them, where z is 0, with its sign too.
  EXPECT_EQ(num_codes, 4 * (127 * 128 / 2 + 127));
}

TEST(ChannelCodes, NormalsOfAnyLengthBecomeDirectionsOfTheUpperHalf) {
  std::mt19937 random(5);
  std::normal_distribution<float> component;
  for (int i = 0; i < 10000; ++i) {
    const openvdb::Vec3f vector(component(random), component(random), component(random));
    VoxelRecord record;
    set_normal_value(record, vector * 10);
    const openvdb::Vec3f normal = normal_value_of(record);
    EXPECT_GE(normal.z(), 0);
    // The code keeps a direction to one degree.
    EXPECT_GT(std::abs(normal.dot(vector.unit())), std::cos(M_PI / 180)) << vector;
  }
}

}  // namespace
}  // namespace vdbmap
