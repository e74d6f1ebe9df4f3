// SPDX-License-Identifier: GPL-3.0-or-later
// Fine registration of real scans: map from the even scans of a drive, odd scans found in it.
#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include "registration/fine/point_to_plane.h"
#include "tests/support/folders.h"
#include "tests/support/pose_distance.h"
#include "tests/support/sanitizers.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/io/point_reader.h"
#include "vdbmap/io/trajectory_file.h"

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
    if (!drive()) GTEST_SKIP() << "needs kitti_drive5 in the folder of real data ($VDBMAP_DATA)";
    ASSERT_EQ(drive()->files.size(), drive()->poses.size());
  }
};

// What the issue asks of every scan, against poses that ICP variants agree on.
bool is_found(const test::PoseDistance& error) { return error.translation <= 0.10 && error.rotation_deg <= 0.3; }

TEST_F(PointToPlaneKitti, OddScansAreFoundFromThePoseOfTheScanBefore) {
  std::vector<double> errors;
  std::size_t num_found = 0;
  for (std::size_t i = 1; i < kNumScans; i += 2) {
    const PointCloud scan = read_points(drive()->files[i]).cloud;
    const FineResult result = align_scan(scan, drive()->map, drive()->poses[i - 1]);
    const test::PoseDistance error = test::distance_between(result.map_from_scan, drive()->poses[i]);
    num_found += is_found(error) ? 1 : 0;
    errors.push_back(error.translation);
    if (!is_found(error)) {
      std::printf("scan %zu: %.3f m, %.3f degrees, inlier share %.2f\n", i, error.translation, error.rotation_deg,
                  result.inlier_share);
    }
  }
  std::sort(errors.begin(), errors.end());
  RecordProperty("median_mm", static_cast<int>(1000 * errors[errors.size() / 2]));
  EXPECT_GE(static_cast<double>(num_found), 0.99 * static_cast<double>(errors.size()));
  EXPECT_LE(errors[errors.size() / 2], 0.04);
}

TEST_F(PointToPlaneKitti, ScansAreFoundFromTwoMetresAndTenDegrees) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> angle(-3.14, 3.14);
  const std::size_t step = test::kIsSanitized ? 4 : 6;
  for (std::size_t i = 1; i < kNumScans; i += step) {
    const PointCloud scan = read_points(drive()->files[i]).cloud;
    for (int trial = 0; trial < (test::kIsSanitized ? 1 : 3); ++trial) {
      const double bearing = angle(random);
      const double turn = angle(random) > 0 ? 10 : -10;
      Eigen::Isometry3d guess = drive()->poses[i] * Eigen::AngleAxisd(turn * EIGEN_PI / 180, Eigen::Vector3d::UnitZ());
      guess.pretranslate(Eigen::Vector3d(2 * std::cos(bearing), 2 * std::sin(bearing), 0));
      const FineResult result = align_scan(scan, drive()->map, guess);
      const test::PoseDistance error = test::distance_between(result.map_from_scan, drive()->poses[i]);
      EXPECT_TRUE(is_found(error)) << "scan " << i << ", trial " << trial << ": " << error.translation << " m, "
                                   << error.rotation_deg << " degrees, inlier share " << result.inlier_share;
    }
  }
}

}  // namespace
}  // namespace vdbmap::registration
