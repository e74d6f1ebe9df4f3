// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/scans/scan_poses.h"

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/random_points.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/kitti/kitti_bin.h"

namespace vdbmap {
namespace {

// KITTI's camera looks along the LiDAR's x, its x to the right, its y down; it stands 0.27 m ahead and 8 cm below.
Eigen::Isometry3d camera_from_lidar() {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  motion.translation() = Eigen::Vector3d(0, -0.08, -0.27);
  return motion;
}

// A drive that turns left.
Trajectory drive_of_the_lidar(double step = 1) {
  Trajectory drive;
  for (int i = 0; i < 10; ++i) {
    const double heading = 0.05 * i;
    drive.map_from_scan.emplace_back(Eigen::Translation3d(step * i, 0.02 * step * i * i, 0) *
                                     Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()));
  }
  drive.map_from_scan[4].reset();
  return drive;
}

Trajectory drive_of_the_camera(double step = 1) {
  return lidar_poses(drive_of_the_lidar(step), camera_from_lidar().inverse());
}

// A street around a scanner that lies level, and the same in the frame of the camera.
PointCloud level_scan() {
  PointCloud scan;
  scan.positions = test::random_points(500, {Eigen::Vector3d(-40, -12, -2), Eigen::Vector3d(40, 12, 4)}, 1);
  scan.intensities.assign(scan.size(), 0.5F);
  return scan;
}

PointCloud scan_in_camera_frame() {
  PointCloud scan = level_scan();
  for (Eigen::Vector3d& point : scan.positions) point = camera_from_lidar() * point;
  return scan;
}

class ScanPosesOfADrive : public testing::Test {
 protected:
  ScanPosesOfADrive() { std::filesystem::create_directories(folder_ / "00" / "velodyne"); }

  ScanPoses read(const Trajectory& poses, PoseFrame frame = PoseFrame::kUnknown,
                 const PointCloud& scan = level_scan()) const {
    write_trajectory(poses_, poses, TrajectoryFormat::kKitti);
    write_kitti_bin(scan_, scan);
    return read_scan_poses(poses_, std::vector<ScanPlace>{{scan_, {}}}, frame);
  }

  std::string error_for(const Trajectory& poses, PoseFrame frame = PoseFrame::kUnknown) const {
    try {
      read(poses, frame);
    } catch (const IoError& error) {
      EXPECT_EQ(error.kind(), IoError::Kind::kMalformed);
      return error.what();
    }
    return "no error";
  }

  void put_calibration(const std::filesystem::path& folder, const std::string& name = "Tr:") const {
    std::ofstream file(folder / "calib.txt");
    file << "P0: 7.188560e+02 0 6.071928e+02 0 0 7.188560e+02 1.852157e+02 0 0 0 1 0\n"
         << name << " 0 -1 0 0 0 0 -1 -0.08 1 0 0 -0.27\n";
  }

  static void expect_same(const Trajectory& poses, const Trajectory& expected) {
    ASSERT_EQ(poses.size(), expected.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
      ASSERT_EQ(poses.map_from_scan[i].has_value(), expected.map_from_scan[i].has_value()) << i;
      if (poses.map_from_scan[i]) {
        EXPECT_TRUE(poses.map_from_scan[i]->isApprox(*expected.map_from_scan[i], 1e-9)) << i;
      }
    }
  }

  test::TemporaryFolder folder_;
  std::filesystem::path scan_ = folder_ / "00" / "velodyne" / "000000.bin";
  std::filesystem::path poses_ = folder_ / "poses.txt";
};

TEST_F(ScanPosesOfADrive, OfTheCameraAreMovedToTheLidarAndSaid) {
  for (const std::filesystem::path& place : {folder_.path(), folder_ / "00", folder_ / "00" / "velodyne"}) {
    put_calibration(place);
    const ScanPoses read_poses = read(drive_of_the_camera());
    expect_same(read_poses.poses, drive_of_the_lidar());
    EXPECT_EQ(read_poses.frame, PoseFrame::kCamera);
    EXPECT_EQ(read_poses.calibration, place / "calib.txt");
    ASSERT_EQ(read_poses.poses.findings.size(), 1U);
    EXPECT_NE(read_poses.poses.findings[0].what.find("camera's"), std::string::npos);
    std::filesystem::remove(place / "calib.txt");
  }
  put_calibration(folder_.path(), "Tr_velo_to_cam:");
  expect_same(read(drive_of_the_camera()).poses, drive_of_the_lidar());
}

TEST_F(ScanPosesOfADrive, OfTheCameraWithoutACalibrationAreRefusedWithAdvice) {
  const std::string message = error_for(drive_of_the_camera());
  EXPECT_NE(message.find("poses.txt: the poses go mostly along their z axis"), std::string::npos) << message;
  EXPECT_NE(message.find("calib.txt"), std::string::npos) << message;
  EXPECT_NE(message.find("--pose-frame lidar"), std::string::npos) << message;
  EXPECT_NE(error_for(drive_of_the_lidar(), PoseFrame::kCamera).find("there is no calib.txt"), std::string::npos);
}

TEST_F(ScanPosesOfADrive, OfTheLidarStayAndTheCalibrationIsSaidNotToBeUsed) {
  ScanPoses read_poses = read(drive_of_the_lidar());
  expect_same(read_poses.poses, drive_of_the_lidar());
  EXPECT_TRUE(read_poses.poses.findings.empty());
  put_calibration(folder_.path());
  read_poses = read(drive_of_the_lidar());
  expect_same(read_poses.poses, drive_of_the_lidar());
  EXPECT_EQ(read_poses.frame, PoseFrame::kLidar);
  EXPECT_TRUE(read_poses.calibration.empty());
  ASSERT_EQ(read_poses.poses.findings.size(), 1U);
  EXPECT_NE(read_poses.poses.findings[0].what.find("is not used"), std::string::npos);
}

TEST_F(ScanPosesOfADrive, WhatIsSaidDecidesOverTheMotion) {
  put_calibration(folder_.path());
  expect_same(read(drive_of_the_camera(), PoseFrame::kLidar).poses, drive_of_the_camera());
  expect_same(read(drive_of_the_lidar(), PoseFrame::kCamera).poses,
              lidar_poses(drive_of_the_lidar(), camera_from_lidar()));
}

TEST_F(ScanPosesOfADrive, ThatHardlyMovesIsAskedAboutWhereACalibrationLies) {
  expect_same(read(drive_of_the_camera(0.01)).poses, drive_of_the_camera(0.01));
  put_calibration(folder_.path());
  EXPECT_NE(error_for(drive_of_the_camera(0.01)).find("say --pose-frame lidar or camera"), std::string::npos);
  expect_same(read(drive_of_the_camera(0.01), PoseFrame::kCamera).poses, drive_of_the_lidar(0.01));
}

TEST_F(ScanPosesOfADrive, ASinglePoseIsTheLidars) {
  put_calibration(folder_.path());
  Trajectory single;
  single.map_from_scan = {Eigen::Isometry3d::Identity()};
  const ScanPoses read_poses = read(single);
  EXPECT_EQ(read_poses.frame, PoseFrame::kLidar);
  EXPECT_EQ(read_poses.poses.findings.size(), 1U);
}

TEST_F(ScanPosesOfADrive, WhoseScansAreInTheCamerasFrameTooFitsItsPoses) {
  expect_same(read(drive_of_the_camera(), PoseFrame::kUnknown, scan_in_camera_frame()).poses, drive_of_the_camera());
}

TEST_F(ScanPosesOfADrive, NeedsACalibrationThatIsOne) {
  for (const std::string text : {"", "P0: 1 0 0 0 0 1 0 0 0 0 1 0\n"}) {
    std::ofstream(folder_ / "calib.txt") << text;
    EXPECT_NE(error_for(drive_of_the_camera()).find("calib.txt: has no line 'Tr:'"), std::string::npos) << text;
  }
  for (const std::string numbers : {"1 2 3", "1 0 0 0 0 1 0 0 0 0 2 0", "1 0 0 x 0 1 0 0 0 0 1 0",
                                    "1 0 0 0 0 1 0 0 0 0 -1 0", "1 0 0 nan 0 1 0 0 0 0 1 0"}) {
    std::ofstream(folder_ / "calib.txt") << "# comment\nTr: " << numbers << "\n";
    EXPECT_NE(error_for(drive_of_the_camera()).find("calib.txt:2: Tr: is no rigid motion"), std::string::npos)
        << numbers;
  }
}

TEST(FrameByMotion, TellsAxesApartOfAnyAbsolutePose) {
  const Eigen::Isometry3d world(Eigen::Translation3d(5e5, 5e6, 50) *
                                Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()));
  Trajectory lidar = drive_of_the_lidar();
  Trajectory camera = drive_of_the_camera();
  for (auto* poses : {&lidar, &camera}) {
    for (auto& pose : poses->map_from_scan) {
      if (pose) pose = world * *pose;
    }
  }
  EXPECT_EQ(frame_by_motion(lidar), PoseFrame::kLidar);
  EXPECT_EQ(frame_by_motion(camera), PoseFrame::kCamera);
  EXPECT_EQ(frame_by_motion({}), PoseFrame::kUnknown);
}

}  // namespace
}  // namespace vdbmap
