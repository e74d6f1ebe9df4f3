// SPDX-License-Identifier: GPL-3.0-or-later
// Localization of real scans with no first guess: maps of the even scans of two drives, batches of the odd ones, and
// batches of one drive in the map of the other.
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "registration/sequence.h"
#include "tests/support/folders.h"
#include "tests/support/pose_distance.h"
#include "tests/support/sanitizers.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/io/points/point_reader.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::registration {
namespace {

// The whole drives, or their first scans where they would take minutes.
constexpr std::size_t kMaxScans = test::kIsSanitized ? 8 : 64;

struct SequenceDrive {
  VoxelMap map;                   // of the even scans
  std::vector<PointCloud> scans;  // the odd ones
  std::vector<Eigen::Isometry3d> map_from_scan;
};

std::optional<SequenceDrive> load(const std::string& name) {
  const auto data = test::real_data_folder();
  if (!data || !std::filesystem::is_directory(*data / name / "velodyne")) return std::nullopt;
  const auto files = list_point_files({*data / name / "velodyne"});
  const Trajectory poses = read_trajectory(*data / name / "poses.txt");
  SequenceDrive drive;
  MapBuilder builder{BuildOptions()};
  for (std::size_t i = 0; i < std::min(files.size(), kMaxScans); ++i) {
    PointCloud scan = read_points(files[i]).cloud;
    if (i % 2 == 0) {
      builder.add(scan, poses.map_from_scan[i].value());
    } else {
      drive.scans.push_back(std::move(scan));
      drive.map_from_scan.push_back(poses.map_from_scan[i].value());
    }
  }
  drive.map = builder.finish();
  return drive;
}

class SequenceKitti : public testing::Test {
 protected:
  static const std::optional<SequenceDrive>& city() {
    static const std::optional<SequenceDrive> drive = load("kitti_drive5");
    return drive;
  }
  static const std::optional<SequenceDrive>& residential() {
    static const std::optional<SequenceDrive> drive = load("kitti00");
    return drive;
  }

  void SetUp() override {
    if (!city() || !residential()) GTEST_SKIP() << test::kNeedsRealData;
  }
};

// A sensor that is mounted turned about the vertical.
PointCloud turned(PointCloud scan, double yaw) {
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (Eigen::Vector3d& point : scan.positions) point = rotation * point;
  return scan;
}

SequenceResult localize_drive(const SequenceDrive& drive, const VoxelMap& map, double yaw, std::size_t batch_size) {
  LocalizerOptions options;
  options.batch_size = batch_size;
  SequenceLocalizer localizer(map, options);
  for (const PointCloud& scan : drive.scans) localizer.add(turned(scan, yaw));
  return localizer.finish();
}

// What the issue asks: 0.10 m and 0.5 degrees.
void expect_drive_found(const SequenceDrive& drive, double yaw, std::size_t batch_size) {
  const SequenceResult result = localize_drive(drive, drive.map, yaw, batch_size);
  const Eigen::Isometry3d scan_from_turned(Eigen::AngleAxisd(-yaw, Eigen::Vector3d::UnitZ()));
  for (std::size_t i = 0; i < drive.scans.size(); ++i) {
    EXPECT_TRUE(result.scans[i].found()) << i << ": " << result.scans[i].reason;
    const auto error = test::distance_between(result.scans[i].map_from_scan, drive.map_from_scan[i] * scan_from_turned);
    EXPECT_LE(error.translation, 0.10) << i;
    EXPECT_LE(error.rotation_deg, 0.5) << i;
  }
}

TEST_F(SequenceKitti, FindsEveryScanOfACityStreet) { expect_drive_found(*city(), 2.2, 20); }

TEST_F(SequenceKitti, FindsEveryScanOfAResidentialStreet) { expect_drive_found(*residential(), -1.1, 8); }

TEST_F(SequenceKitti, FindsEveryScanInSmallBatches) { expect_drive_found(*city(), -2.9, 5); }

TEST_F(SequenceKitti, FindsNoScanOfAnotherStreet) {
  for (const std::size_t batch_size : {4U, 20U}) {
    for (const SequenceScan& scan : localize_drive(*residential(), city()->map, 0.7, batch_size).scans) {
      EXPECT_FALSE(scan.found());
    }
    for (const SequenceScan& scan : localize_drive(*city(), residential()->map, 0.7, batch_size).scans) {
      EXPECT_FALSE(scan.found());
    }
  }
}

}  // namespace
}  // namespace vdbmap::registration
