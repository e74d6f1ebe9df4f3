// SPDX-License-Identifier: GPL-3.0-or-later
// Fine registration of real scans: map from the even scans of a drive, odd scans found in it.
#include <algorithm>
#include <optional>
#include <random>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "registration/fine/point_to_plane.h"
#include "tests/support/folders.h"
#include "tests/support/pose_distance.h"
#include "tests/support/random_points.h"
#include "tests/support/sanitizers.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/io/points/point_reader.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::registration {
namespace {

// The whole drive, or its first scans where they would take minutes.
constexpr std::size_t kNumScans = test::kIsSanitized ? 6 : 64;

struct Drive {
  std::vector<std::filesystem::path> files;
  std::vector<Eigen::Isometry3d> poses;
  VoxelMap map;
};

std::optional<Drive> load_drive() {
  const auto data = test::real_data_folder();
  if (!data || !std::filesystem::is_directory(*data / "kitti_drive5" / "velodyne")) return std::nullopt;
  Drive drive;
  drive.files = list_point_files({*data / "kitti_drive5" / "velodyne"});
  for (const auto& pose : read_trajectory(*data / "kitti_drive5" / "poses.txt").map_from_scan) {
    drive.poses.push_back(pose.value());
  }
  MapBuilder builder{BuildOptions()};
  for (std::size_t i = 0; i < kNumScans; i += 2) builder.add(read_points(drive.files[i]).cloud, drive.poses[i]);
  drive.map = builder.finish();
  return drive;
}

class PointToPlaneKitti : public testing::Test {
 protected:
  static const std::optional<Drive>& drive() {
    static const std::optional<Drive> loaded = load_drive();
    return loaded;
  }

  void SetUp() override {
    if (!drive()) GTEST_SKIP() << test::kNeedsRealData;
    ASSERT_EQ(drive()->files.size(), drive()->poses.size());
  }
};

// What the issue asks of every scan, against poses that ICP variants agree on.
bool is_found(const test::PoseDistance& error) { return error.translation <= 0.10 && error.rotation_deg <= 0.3; }

std::string describe(std::size_t scan, const test::PoseDistance& error, const FineResult& result) {
  std::ostringstream text;
  text << "scan " << scan << ": " << error.translation << " m, " << error.rotation_deg << " degrees, inlier share "
       << result.inlier_share << '\n';
  return text.str();
}

TEST_F(PointToPlaneKitti, OddScansAreFoundFromThePoseOfTheScanBefore) {
  std::vector<double> errors;
  std::string lost;
  std::size_t num_found = 0;
  for (std::size_t i = 1; i < kNumScans; i += 2) {
    const FineResult result = align_scan(read_points(drive()->files[i]).cloud, drive()->map, drive()->poses[i - 1]);
    const test::PoseDistance error = test::distance_between(result.map_from_scan, drive()->poses[i]);
    errors.push_back(error.translation);
    if (is_found(error)) {
      ++num_found;
    } else {
      lost += describe(i, error, result);
    }
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_GE(static_cast<double>(num_found), 0.99 * static_cast<double>(errors.size())) << lost;
  EXPECT_LE(errors[errors.size() / 2], 0.04);
}

// A guess 2 m and 10 degrees off: level and in heading, as odometry errs, or in any direction.
Eigen::Isometry3d far_guess(const Eigen::Isometry3d& pose, bool level, std::mt19937& random) {
  Eigen::Isometry3d offset = test::random_motion(2, 10, random);
  if (level) {
    const double turn_deg = offset.translation().x() > 0 ? 10 : -10;
    offset.linear() = Eigen::AngleAxisd(turn_deg * EIGEN_PI / 180, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    offset.translation().z() = 0;
    offset.translation() *= 2 / offset.translation().norm();
  }
  Eigen::Isometry3d guess = pose;
  guess.linear() = offset.linear() * pose.linear();
  guess.translation() += offset.translation();
  return guess;
}

TEST_F(PointToPlaneKitti, ScansAreFoundFromTwoMetresAndTenDegrees) {
  std::mt19937 random(1);
  const std::size_t step = test::kIsSanitized ? 4 : 8;
  for (std::size_t i = 1; i < kNumScans; i += step) {
    const PointCloud scan = read_points(drive()->files[i]).cloud;
    for (const bool level : {true, false}) {
      const FineResult result = align_scan(scan, drive()->map, far_guess(drive()->poses[i], level, random));
      const test::PoseDistance error = test::distance_between(result.map_from_scan, drive()->poses[i]);
      EXPECT_TRUE(is_found(error)) << describe(i, error, result);
      EXPECT_TRUE(result.converged) << describe(i, error, result);
    }
  }
}

}  // namespace
}  // namespace vdbmap::registration
