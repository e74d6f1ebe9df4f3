// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/kitti_bin.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"

namespace vdbmap {
namespace {

using test::io_error_of;
using test::raw;

class KittiBin : public testing::Test {
 protected:
  ReadResult read(const std::string& bytes) const {
    return read_kitti_bin(test::write_raw(folder_ / "scan.bin", bytes));
  }
  std::string error(const std::string& bytes) const {
    return io_error_of([&] { read(bytes); });
  }

  test::TemporaryFolder folder_;
};

TEST_F(KittiBin, ReadsPositionAndIntensity) {
  const ReadResult result = read(raw(1.5f, -2.5f, 0.25f, 0.75f, 4.0f, 5.0f, 6.0f, 0.0f));
  ASSERT_EQ(result.cloud.size(), 2u);
  EXPECT_EQ(result.cloud.positions[0], Eigen::Vector3d(1.5, -2.5, 0.25));
  EXPECT_EQ(result.cloud.intensities, (std::vector<float>{0.75f, 0.0f}));
}

TEST_F(KittiBin, DropsAndCountsPointsThatAreNotFinite) {
  const ReadResult result = read(raw(NAN, 0.0f, 0.0f, 1.0f, 4.0f, 5.0f, 6.0f, 2.0f, 0.0f, -INFINITY, 0.0f, 3.0f));
  EXPECT_EQ(result.dropped.size(), 2u);
  EXPECT_EQ(result.cloud.intensities, std::vector<float>{2.0f});
}

TEST_F(KittiBin, RefusesAPartOfAPoint) {
  EXPECT_EQ(error(raw(1.0f, 2.0f, 3.0f, 4.0f, 5.0f)),
            "scan.bin: byte 16: the file ends within a point: 20 bytes are not a multiple of 16");
  EXPECT_EQ(error(""), "scan.bin: the file holds no points");
}

TEST_F(KittiBin, WritesZeroWhereThereIsNoIntensity) {
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}};
  write_kitti_bin(folder_ / "scan.bin", cloud);
  EXPECT_EQ(test::read_raw(folder_ / "scan.bin"), raw(1.0f, 2.0f, 3.0f, 0.0f));
}

TEST_F(KittiBin, ReadsTheScansOfKitti) {
  const auto data = test::real_data_folder();
  if (!data) GTEST_SKIP() << test::kNeedsRealData;

  const std::filesystem::path path = list_point_files({*data / "kitti_drive5" / "velodyne"}).front();
  const PointCloud cloud = read_kitti_bin(path).cloud;
  const std::string bytes = test::read_raw(path);
  ASSERT_EQ(cloud.size(), bytes.size() / 16);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const char* record = bytes.data() + 16 * i;
    ASSERT_EQ(cloud.positions[i],
              Eigen::Vector3d(load<float>(record), load<float>(record + 4), load<float>(record + 8)));
    ASSERT_LT(cloud.positions[i].norm(), 130.0);  // [m] the sensor's range
    ASSERT_EQ(cloud.intensities[i], load<float>(record + 12));
    ASSERT_LE(cloud.intensities[i], 1.0f);
  }
}

}  // namespace
}  // namespace vdbmap
