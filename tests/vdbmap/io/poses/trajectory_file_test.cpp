// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/poses/trajectory_file.h"

#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "vdbmap/core/error.h"

namespace vdbmap {
namespace {

constexpr const char* kIdentityLine = "1 0 0 0 0 1 0 0 0 0 1 0\n";
constexpr const char* kMissingLine = "nan nan nan nan nan nan nan nan nan nan nan nan\n";

Eigen::Isometry3d pose_at(const Eigen::Vector3d& position, double yaw, double pitch, double roll) {
  return Eigen::Translation3d(position) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
}

Trajectory trajectory_at_utm_coordinates() {
  Trajectory trajectory;
  for (int i = 0; i < 20; ++i) {
    const double turn = 0.7 * i;  // more than one turn over all poses: every sign of the quaternion
    trajectory.map_from_scan.emplace_back(pose_at({550123.456789012 + i, 5802345.678901234 - i, 55.1 + 0.1 * i}, turn,
                                                  0.3 * std::sin(turn), 3 * std::cos(turn)));
  }
  return trajectory;
}

class TrajectoryFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) const {
    std::ofstream(path_, std::ios::binary) << text;
    return path_;
  }

  std::string written_text() const { return test::read_raw(path_); }

  std::string error_for(const std::string& text) const {
    try {
      read_trajectory(write(text));
    } catch (const IoError& error) {
      EXPECT_EQ(error.kind(), IoError::Kind::kMalformed);
      return error.what();
    }
    return "no error";
  }

  test::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "poses.txt";
};

class TrajectoryFormats : public TrajectoryFile, public testing::WithParamInterface<TrajectoryFormat> {};

INSTANTIATE_TEST_SUITE_P(, TrajectoryFormats, testing::Values(TrajectoryFormat::kKitti, TrajectoryFormat::kTum),
                         [](const auto& format) { return format.param == TrajectoryFormat::kKitti ? "Kitti" : "Tum"; });

TEST_P(TrajectoryFormats, RoundTripKeepsUtmCoordinates) {
  const Trajectory trajectory = trajectory_at_utm_coordinates();
  write_trajectory(path_, trajectory, GetParam());
  const Trajectory reread = read_trajectory(path_);

  ASSERT_EQ(reread.size(), trajectory.size());
  for (std::size_t i = 0; i < reread.size(); ++i) {
    ASSERT_TRUE(reread.map_from_scan[i].has_value());
    EXPECT_EQ(reread.map_from_scan[i]->translation(), trajectory.map_from_scan[i]->translation());
    EXPECT_TRUE(reread.map_from_scan[i]->linear().isApprox(trajectory.map_from_scan[i]->linear(), 1e-9)) << i;
  }
}

TEST_P(TrajectoryFormats, TruncationAnywhereGivesFewerPosesOrAnErrorWithItsLine) {
  Trajectory trajectory = trajectory_at_utm_coordinates();
  trajectory.map_from_scan.resize(3);
  write_trajectory(path_, trajectory, GetParam());
  const std::string whole = written_text();

  for (std::size_t size = 0; size < whole.size(); ++size) {
    write(whole.substr(0, size));
    try {
      EXPECT_LE(read_trajectory(path_).size(), 3U);
    } catch (const IoError& error) {
      EXPECT_EQ(error.kind(), IoError::Kind::kMalformed);
      EXPECT_NE(std::string(error.what()).find("poses.txt:"), std::string::npos) << error.what();
    }
  }
}

TEST_F(TrajectoryFile, TumKeepsTimesAndLeavesMissingPosesOut) {
  Trajectory trajectory;
  trajectory.map_from_scan = {Eigen::Isometry3d::Identity(), std::nullopt, pose_at({1, 2, 3}, 0.5, 0, 0)};
  trajectory.times = {1317040000.123456, 1317040000.223456, 1317040000.323456};
  write_trajectory(path_, trajectory, TrajectoryFormat::kTum);
  const Trajectory reread = read_trajectory(path_);

  EXPECT_EQ(reread.times, (std::vector<double>{1317040000.123456, 1317040000.323456}));
  EXPECT_TRUE(reread.map_from_scan[1]->isApprox(*trajectory.map_from_scan[2], 1e-15));
}

TEST_F(TrajectoryFile, TumWithoutTimesNumbersThePoses) {
  Trajectory trajectory;
  trajectory.map_from_scan = {Eigen::Isometry3d::Identity(), std::nullopt, Eigen::Isometry3d::Identity()};
  write_trajectory(path_, trajectory, TrajectoryFormat::kTum);

  EXPECT_EQ(read_trajectory(path_).times, (std::vector<double>{0, 2}));
}

TEST_F(TrajectoryFile, TumLeavesPosesWithoutATimeOutAndTheOthersKeepTheirs) {
  Trajectory trajectory;
  trajectory.map_from_scan = {Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity(), std::nullopt,
                              Eigen::Isometry3d::Identity()};
  trajectory.times = {10, std::nan(""), std::nan(""), 10.3};
  write_trajectory(path_, trajectory, TrajectoryFormat::kTum);

  EXPECT_EQ(read_trajectory(path_).times, (std::vector<double>{10, 10.3}));
}

TEST_F(TrajectoryFile, TumHasTheScalarPartLast) {
  write("0 1 2 3 0 0 0.70710678118654752 0.70710678118654752\n");  // a quarter turn to the left
  const Eigen::Isometry3d map_from_scan = *read_trajectory(path_).map_from_scan[0];

  EXPECT_TRUE((map_from_scan * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d(1, 3, 3), 1e-15));
}

TEST_F(TrajectoryFile, KittiIsRowMajor) {
  write("0 -1 0 1 1 0 0 2 0 0 1 3\n");  // a quarter turn to the left
  const Eigen::Isometry3d map_from_scan = *read_trajectory(path_).map_from_scan[0];

  EXPECT_TRUE((map_from_scan * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d(1, 3, 3), 1e-15));
}

TEST_F(TrajectoryFile, KittiKeepsThePlaceOfMissingPoses) {
  Trajectory trajectory;
  trajectory.map_from_scan = {std::nullopt, Eigen::Isometry3d::Identity(), std::nullopt};
  write_trajectory(path_, trajectory, TrajectoryFormat::kKitti);
  EXPECT_EQ(written_text(), std::string(kMissingLine) + kIdentityLine + kMissingLine);

  const Trajectory reread = read_trajectory(path_);
  ASSERT_EQ(reread.size(), 3U);
  EXPECT_FALSE(reread.map_from_scan[0].has_value());
  EXPECT_TRUE(reread.map_from_scan[1].has_value());
  EXPECT_FALSE(reread.map_from_scan[2].has_value());
}

TEST_F(TrajectoryFile, CommentsBlankLinesAndWindowsLineEndsAreNoPoses) {
  write("# time x y z qx qy qz qw\r\n\r\n1.5 1 2 3 0 0 0 1\r\n  # in between\r\n2.5\t4  5 6 0 0 0 1");
  const Trajectory trajectory = read_trajectory(path_);

  EXPECT_EQ(trajectory.times, (std::vector<double>{1.5, 2.5}));
  EXPECT_EQ(trajectory.map_from_scan[1]->translation(), Eigen::Vector3d(4, 5, 6));
}

TEST_F(TrajectoryFile, RotationsBecomeExactlyOrthonormal) {
  write("0.9998 -0.0174 0 0 0.0174 0.9998 0 0 0 0 1 0\n");
  const Eigen::Matrix3d rotation = read_trajectory(path_).map_from_scan[0]->linear();

  EXPECT_TRUE((rotation.transpose() * rotation).isIdentity(1e-15));
  EXPECT_NEAR(rotation.determinant(), 1, 1e-15);
  EXPECT_NEAR(std::atan2(rotation(1, 0), rotation(0, 0)), std::atan2(0.0174, 0.9998), 1e-15);
}

TEST_F(TrajectoryFile, WrongColumnsAreNamedWithTheirLine) {
  EXPECT_NE(error_for("1 2 3\n").find("poses.txt:1: 3 columns, expected 12 (KITTI) or 8 (TUM)"), std::string::npos);
  EXPECT_NE(error_for(std::string(kIdentityLine) + "0 0 0 0 0 0 0 1\n").find("poses.txt:2: 8 columns, expected 12"),
            std::string::npos);
  EXPECT_NE(error_for("0 0 0 0 0 0 0 1\n" + std::string(kIdentityLine)).find("poses.txt:2: 12 columns, expected 8"),
            std::string::npos);
}

TEST_F(TrajectoryFile, MatricesThatAreNotRotationsAreRefused) {
  EXPECT_NE(error_for("1 0 0 0 0 1 0 0 0 0 -1 0\n").find(":1: matrix is not a rotation but a reflection"),
            std::string::npos);
  for (const std::string line : {"2 0 0 0 0 2 0 0 0 0 2 0", "1 0.01 0 0 0 1 0 0 0 0 1 0", "0 0 0 0 0 0 0 0 0 0 0 0",
                                 "1e200 0 0 0 0 1e200 0 0 0 0 1e200 0", "1 0 0 0 1 0 0 0 0 0 1 0"}) {
    EXPECT_NE(error_for(line).find(":1: matrix is not a rotation"), std::string::npos) << line;
  }
}

TEST_F(TrajectoryFile, QuaternionsThatAreNotRotationsAreRefused) {
  for (const std::string line :
       {"0 1 2 3 0 0 0 1.1", "0 1 2 3 0 0 0 0.98", "0 1 2 3 0 0 0 1e-9", "0 1 2 3 1 1 1 1", "0 1 2 3 1e200 0 0 0"}) {
    EXPECT_NE(error_for(line).find(":1: quaternion is not a rotation"), std::string::npos) << line;
  }
}

TEST_F(TrajectoryFile, NumbersThatAreNotFiniteAreRefused) {
  EXPECT_NE(error_for("1 0 0 inf 0 1 0 0 0 0 1 0\n").find(":1: column 4"), std::string::npos);
  EXPECT_NE(error_for("1 0 0 1e999 0 1 0 0 0 0 1 0\n").find(":1: column 4"), std::string::npos);
  EXPECT_NE(error_for("1 0 0 nan 0 1 0 0 0 0 1 0\n").find(":1: pose with 1 of 12 numbers nan"), std::string::npos);
  EXPECT_NE(error_for("nan 1 2 3 0 0 0 1\n").find(":1: time is nan"), std::string::npos);
}

TEST_F(TrajectoryFile, GarbageIsRefusedInOneLine) {
  EXPECT_NE(error_for("1 0 0 x7 0 1 0 0 0 0 1 0\n").find(":1: column 4 is 'x7'"), std::string::npos);
  EXPECT_NE(error_for("1 0 0 0 0 1 0 0 0 0 1 1.5e\n").find(":1: column 12 is '1.5e'"), std::string::npos);
  using namespace std::string_literals;
  const std::string bytes = "\x89PNG\x1a\0\0\0 not a pose \xff\xfe\n"s;
  const std::string message = error_for(bytes);
  EXPECT_NE(message.find("poses.txt:1: "), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST_F(TrajectoryFile, FilesWithoutAPoseAreRefused) {
  for (const std::string text : {"", "\n\n", "# only a comment\n"}) {
    EXPECT_NE(error_for(text).find("poses.txt: holds no poses"), std::string::npos) << text;
  }
}

TEST_F(TrajectoryFile, UnreadableFilesAreSystemErrors) {
  for (const std::filesystem::path& path : {folder_ / "missing.txt", folder_.path()}) {
    try {
      read_trajectory(path);
      FAIL() << path;
    } catch (const IoError& error) {
      EXPECT_EQ(error.kind(), IoError::Kind::kSystem);
    }
  }
}

TEST_F(TrajectoryFile, TimesMustBeAsManyAsPoses) {
  Trajectory trajectory;
  trajectory.map_from_scan = {Eigen::Isometry3d::Identity()};
  trajectory.times = {0, 1};
  EXPECT_THROW(write_trajectory(path_, trajectory, TrajectoryFormat::kTum), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(TrajectoryFile, ReadsTheRealDrive) {
  const auto data = test::real_data_folder();
  if (!data) GTEST_SKIP() << test::kNeedsRealData;
  EXPECT_EQ(read_trajectory(*data / "kitti_drive5" / "poses.txt").size(), 64U);
}

}  // namespace
}  // namespace vdbmap
