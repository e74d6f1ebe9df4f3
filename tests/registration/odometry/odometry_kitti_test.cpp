// SPDX-License-Identifier: GPL-3.0-or-later
// Odometry of real drives against the poses that ICP variants agree on to 0.15 m.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "registration/odometry/odometry.h"
#include "tests/support/folders.h"
#include "tests/support/sanitizers.h"
#include "vdbmap/io/points/point_reader.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::registration {
namespace {

struct DriveCase {
  std::string folder;
  int every_ring = 1;
};

// KITTI's points are in ring order; each ring begins where the azimuth falls from 360 degrees to 0.
PointCloud with_every_ring(const PointCloud& scan, int every) {
  PointCloud thinned;
  int ring = 0;
  double last_azimuth = 0;
  for (const Eigen::Vector3d& point : scan.positions) {
    double azimuth = std::atan2(point.y(), point.x());
    if (azimuth < 0) azimuth += 2 * std::numbers::pi;
    if (last_azimuth - azimuth > std::numbers::pi) ++ring;
    last_azimuth = azimuth;
    if (ring % every == 0) thinned.positions.push_back(point);
  }
  return thinned;
}

class OdometryKitti : public testing::TestWithParam<DriveCase> {
 protected:
  void SetUp() override {
    const auto data = test::real_data_folder();
    if (!data || !std::filesystem::is_directory(*data / GetParam().folder / "velodyne")) {
      GTEST_SKIP() << test::kNeedsRealData;
    }
    files_ = list_point_files({*data / GetParam().folder / "velodyne"});
    if (test::kIsSanitized) files_.resize(std::min<std::size_t>(files_.size(), 6));
    truth_ = read_trajectory(*data / GetParam().folder / "poses.txt");
  }

  PointCloud scan(std::size_t i) const { return with_every_ring(read_points(files_[i]).cloud, GetParam().every_ring); }

  double xy_error(const OdometryStep& step, std::size_t i) const {
    const Eigen::Isometry3d true_pose = truth_.map_from_scan[0]->inverse() * *truth_.map_from_scan[i];
    return (step.first_from_scan.translation() - true_pose.translation()).head<2>().norm();
  }

  std::vector<std::filesystem::path> files_;
  Trajectory truth_;
};

TEST_P(OdometryKitti, EveryScanIsWithinFifteenCentimetres) {
  Odometry odometry;
  for (std::size_t i = 0; i < files_.size(); ++i) {
    const OdometryStep step = odometry.register_scan(scan(i));
    ASSERT_TRUE(step.registered()) << i << ": " << step.reason;
    EXPECT_LT(xy_error(step, i), 0.15) << i;
    EXPECT_FALSE(step.was_refound) << i;
  }
}

TEST_P(OdometryKitti, AGapOfEightScansIsBridged) {
  Odometry odometry;
  const std::size_t gap = files_.size() > 32 ? 24 : 5;
  for (std::size_t i = 0; i < std::min<std::size_t>(files_.size(), gap + 10); ++i) {
    if (i >= gap && i < gap + 8) continue;
    const OdometryStep step = odometry.register_scan(scan(i));
    ASSERT_TRUE(step.registered()) << i << ": " << step.reason;
    EXPECT_LT(xy_error(step, i), 0.15) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Drives, OdometryKitti,
                         testing::Values(DriveCase{"kitti_drive5"}, DriveCase{"kitti00"}, DriveCase{"kitti_drive5", 4},
                                         DriveCase{"kitti00", 4}),
                         [](const auto& drive) {
                           return drive.param.folder + (drive.param.every_ring == 1 ? "" : "_every_fourth_ring");
                         });

TEST(OdometryOfTwoPlaces, AnotherStreetIsRefused) {
  const auto data = test::real_data_folder();
  if (!data || !std::filesystem::is_directory(*data / "kitti_drive5") ||
      !std::filesystem::is_directory(*data / "kitti00")) {
    GTEST_SKIP() << test::kNeedsRealData;
  }
  const auto here = list_point_files({*data / "kitti_drive5" / "velodyne"});
  const auto there = list_point_files({*data / "kitti00" / "velodyne"});
  Odometry odometry;
  for (std::size_t i = 0; i < 3; ++i) odometry.register_scan(read_points(here[i]).cloud);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_FALSE(odometry.register_scan(read_points(there[i]).cloud).registered());
  EXPECT_TRUE(odometry.register_scan(read_points(here[3]).cloud).registered());
}

}  // namespace
}  // namespace vdbmap::registration
