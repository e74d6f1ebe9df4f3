// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/las/las.h"

namespace vdbmap {
namespace {

// Coordinates of a city in UTM, and attributes that LAS can hold exactly.
PointCloud random_cloud(std::size_t size) {
  std::mt19937_64 random(5);
  const auto within = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  PointCloud cloud;
  for (std::size_t i = 0; i < size; ++i) {
    cloud.positions.emplace_back(within(500000, 600000), within(5.8e6, 5.9e6), within(-50, 500));
    cloud.colors.push_back({static_cast<std::uint16_t>(random()), static_cast<std::uint16_t>(random()), 300});
    cloud.intensities.push_back(static_cast<float>(random() % 65536));
    cloud.times.push_back(within(0, 1e9));
    cloud.labels.push_back(static_cast<std::uint16_t>(random() % 32));
  }
  return cloud;
}

class LasWriter : public testing::TestWithParam<unsigned> {
 protected:
  ReadResult write_and_read(const PointCloud& cloud, const LasWriteOptions& options = {}) const {
    write_las(path_, cloud, options);
    return read_las(path_);
  }

  std::string bytes() const { return test::read_raw(path_); }

  template <Scalar T>
  T header_number(std::size_t at) const {
    return load<T>(bytes().data() + at);
  }

  test::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "cloud.las";
};

INSTANTIATE_TEST_SUITE_P(Formats, LasWriter, testing::Range(0U, 4U));

TEST_P(LasWriter, RoundTripKeepsATenthOfAMillimetreAndAllAttributes) {
  PointCloud cloud = random_cloud(3000);
  if ((GetParam() & 1) == 0) cloud.times.clear();
  if ((GetParam() & 2) == 0) cloud.colors.clear();
  const PointCloud reread = write_and_read(cloud).cloud;

  EXPECT_EQ(header_number<std::uint8_t>(104), GetParam());
  ASSERT_EQ(reread.size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    // Half the resolution and the rounding of doubles at 5.9e6 m.
    ASSERT_LE((reread.positions[i] - cloud.positions[i]).lpNorm<Eigen::Infinity>(), 0.5e-4 + 2e-9);
  }
  EXPECT_EQ(reread.colors, cloud.colors);
  EXPECT_EQ(reread.intensities, cloud.intensities);
  EXPECT_EQ(reread.times, cloud.times);
  EXPECT_EQ(reread.labels, cloud.labels);
}

TEST_F(LasWriter, HeaderHoldsTheBoundsOfThePointsAsTheyAreRead) {
  const PointCloud reread = write_and_read(random_cloud(1000)).cloud;
  for (int axis = 0; axis < 3; ++axis) {
    double high = -HUGE_VAL;
    double low = HUGE_VAL;
    for (const Eigen::Vector3d& position : reread.positions) {
      high = std::max(high, position[axis]);
      low = std::min(low, position[axis]);
    }
    EXPECT_EQ(header_number<double>(179 + 16 * static_cast<std::size_t>(axis)), high);
    EXPECT_EQ(header_number<double>(187 + 16 * static_cast<std::size_t>(axis)), low);
  }
  EXPECT_EQ(header_number<std::uint32_t>(107), 1000U);
  EXPECT_EQ(header_number<std::uint32_t>(111), 1000U);
  EXPECT_EQ(header_number<std::uint16_t>(94), 227U);
  EXPECT_EQ(bytes().size(), 227U + 1000U * 34U);
}

TEST_F(LasWriter, TheCodeIsKept) {
  EXPECT_EQ(write_and_read(random_cloud(10), {.epsg = 25832}).epsg, 25832);
  EXPECT_EQ(write_and_read(random_cloud(10)).epsg, std::nullopt);
}

TEST_F(LasWriter, IntensitiesUpToOneAreStretched) {
  PointCloud cloud = random_cloud(4);
  cloud.intensities = {0, 0.5F, 1, -1};
  EXPECT_EQ(write_and_read(cloud).cloud.intensities, (std::vector<float>{0, 32768, 65535, 0}));

  cloud.intensities = {std::numeric_limits<float>::quiet_NaN(), 0.6F, 1e9F, 2};
  EXPECT_EQ(write_and_read(cloud).cloud.intensities, (std::vector<float>{0, 1, 65535, 2}));
}

TEST_F(LasWriter, TheSamePointsMakeTheSameFile) {
  write_las(path_, random_cloud(100));
  const std::string first = bytes();
  write_las(path_, random_cloud(100));
  EXPECT_EQ(bytes(), first);
}

TEST_F(LasWriter, TheWidestExtentFitsAndAnyWiderIsRefused) {
  PointCloud cloud;
  const double widest = 2147483647e-4;
  cloud.positions = {{-widest, 0, 0}, {widest, 1e7, 0}};
  EXPECT_THROW(write_las(path_, cloud), std::invalid_argument);

  cloud.positions[1].y() = 1e5;
  const PointCloud reread = write_and_read(cloud).cloud;
  EXPECT_NEAR(reread.positions[0].x(), -widest, 1e-9);
  EXPECT_NEAR(reread.positions[1].x(), widest, 1e-9);

  cloud.positions[1].x() = 1.0001 * widest;
  cloud.positions[0].x() = -1.0001 * widest;
  EXPECT_THROW(write_las(path_, cloud), std::invalid_argument);
  EXPECT_NO_THROW(write_las(path_, cloud, {.resolution = 0.001}));
}

TEST_F(LasWriter, WhatLasCannotHoldIsRefusedAndLeavesNoFile) {
  PointCloud cloud = random_cloud(3);
  cloud.labels[2] = 32;
  EXPECT_THROW(write_las(path_, cloud), std::invalid_argument);
  cloud = random_cloud(3);
  cloud.times.pop_back();
  EXPECT_THROW(write_las(path_, cloud), std::invalid_argument);
  cloud = random_cloud(3);
  cloud.positions[0].x() = HUGE_VAL;
  EXPECT_THROW(write_las(path_, cloud), std::invalid_argument);
  cloud = random_cloud(3);
  EXPECT_THROW(write_las(path_, cloud, {.epsg = 32767}), std::invalid_argument);
  EXPECT_THROW(write_las(path_, cloud, {.resolution = 0}), std::invalid_argument);
  EXPECT_THROW(write_las(path_, {}), std::invalid_argument);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

}  // namespace
}  // namespace vdbmap
