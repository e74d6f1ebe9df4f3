// SPDX-License-Identifier: GPL-3.0-or-later
// Poses as other programs write them: each file here holds the same two, and what differs is the way to say them.
#include <cmath>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap {
namespace {

// A quarter turn to the left at (1, 2, 3), and half a turn about x at (4, 5, 6).
Eigen::Isometry3d first_pose() {
  return Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(EIGEN_PI / 2, Eigen::Vector3d::UnitZ());
}
Eigen::Isometry3d second_pose() {
  return Eigen::Translation3d(4, 5, 6) * Eigen::AngleAxisd(EIGEN_PI, Eigen::Vector3d::UnitX());
}

const std::string kS = "0.7071067811865476";

class PoseDialects : public testing::Test {
 protected:
  Trajectory read(const std::string& text) const {
    std::ofstream(path_, std::ios::binary) << text;
    return read_trajectory(path_);
  }

  std::string error_for(const std::string& text) const {
    try {
      read(text);
    } catch (const IoError& error) {
      EXPECT_EQ(error.kind(), IoError::Kind::kMalformed);
      return error.what();
    }
    return "no error";
  }

  void expect_the_two(const std::string& text, double first_time = 1.5) const {
    const Trajectory trajectory = read(text);
    ASSERT_EQ(trajectory.size(), 2U) << text;
    EXPECT_TRUE(trajectory.map_from_scan[0]->isApprox(first_pose(), 1e-12)) << text;
    EXPECT_TRUE(trajectory.map_from_scan[1]->isApprox(second_pose(), 1e-12)) << text;
    if (std::isnan(first_time)) {
      EXPECT_TRUE(trajectory.times.empty()) << text;
    } else {
      ASSERT_EQ(trajectory.times.size(), 2U) << text;
      EXPECT_DOUBLE_EQ(trajectory.times[0], first_time) << text;
    }
  }

  // Lines of words, as TUM's order has them, with another separator.
  static std::string tum(const std::string& separator, const std::string& line_end = "\n") {
    const std::vector<std::string> first = {"1.5", "1", "2", "3", "0", "0", kS, kS};
    const std::vector<std::string> second = {"2.5", "4", "5", "6", "1", "0", "0", "0"};
    std::string text;
    for (const auto& words : {first, second}) {
      for (std::size_t i = 0; i < words.size(); ++i) text += (i > 0 ? separator : "") + words[i];
      text += line_end;
    }
    return text;
  }

  test::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "poses.txt";
};

TEST_F(PoseDialects, NumbersMayBeSeparatedInManyWays) {
  for (const std::string separator : {" ", ",", ", ", " , ", ";", "; ", "\t", ",\t", "   "}) {
    expect_the_two(tum(separator));
    expect_the_two(tum(separator, separator + "\r\n"));  // one more at the end
  }
  expect_the_two(tum(" ", "\r"));
  expect_the_two("\n  " + tum(" ", " \n\n  "));
}

TEST_F(PoseDialects, AByteOrderMarkIsNoPose) {
  expect_the_two("\xEF\xBB\xBF" + tum(" "));
  expect_the_two("\xEF\xBB\xBF# time\n" + tum(" "));
  EXPECT_NE(error_for("\xFF\xFE" + tum(" ")).find("UTF-16"), std::string::npos);
}

TEST_F(PoseDialects, CommentsHaveManyMarks) {
  for (const std::string mark : {"#", "# ", "%", "// "}) expect_the_two(mark + "made by a program\n" + tum(" "));
}

TEST_F(PoseDialects, AHeaderNeedsNoMark) {
  expect_the_two("timestamp tx ty tz qx qy qz qw\n" + tum(" "));
  expect_the_two("time,x,y,z,q_x,q_y,q_z,q_w\n" + tum(","));
  expect_the_two(
      "\"Time [s]\";\"Position X (m)\";\"Position.Y (m)\";position_z;Orientation.x;orientation.y;"
      "orientation.z;orientation.w\n" +
      tum(";"));
  expect_the_two("t\tp x\tp y\tp z\tq x\tq y\tq z\tq w\n" + tum("\t"));
}

TEST_F(PoseDialects, AHeaderIsNeverOverruled) {
  const std::string scalar_first = " " + kS + " 0 0 " + kS;
  const std::string lines = "1.5 1 2 3" + scalar_first + "\n2.5 4 5 6 0 1 0 0\n";
  expect_the_two("# timestamp x y z qw qx qy qz\n" + lines);
  expect_the_two("# made by a program\n#timestamp, x [m], y [m], z [m], qw, qx, qy, qz\n# another remark\n" + lines);
  expect_the_two("time x y z qw qx qy qz\n" + lines);
  expect_the_two("id,qw,qx,qy,qz,z,y,x,seconds,note\n7," + kS + ",0,0," + kS +
                 ",3,2,1,1.5,good\n8,0,1,0,0,6,5,4,2.5,\n");
  expect_the_two("x y z qx qy qz qw\n1 2 3 0 0 " + kS + " " + kS + "\n4 5 6 1 0 0 0\n", std::nan(""));
  EXPECT_NE(error_for("time x y z qx qy qz qw\n1 2 3 4 5 6 7 8 9\n").find(":2: 9 columns, expected 8 as the header"),
            std::string::npos);
}

TEST_F(PoseDialects, EurocIsReadByItsHeader) {
  const std::string header =
      "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], v_RS_R_x [m "
      "s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], b_w_RS_S_x [rad s^-1], b_w_RS_S_y [rad s^-1], b_w_RS_S_z [rad "
      "s^-1], b_a_RS_S_x [m s^-2], b_a_RS_S_y [m s^-2], b_a_RS_S_z [m s^-2]\r\n";
  const std::string rest = ",9,9,9,9,9,9,9,9,9\r\n";
  expect_the_two(
      header + "1403636579763555584,1,2,3," + kS + ",0,0," + kS + rest + "1403636579813555456,4,5,6,0,1,0,0" + rest,
      1403636579.763555584);
}

TEST_F(PoseDialects, UnitsOfTimesAreSaidOrSeenAndThenTold) {
  expect_the_two("#time [ns] x y z qx qy qz qw\n1500000000 1 2 3 0 0 " + kS + " " + kS + "\n2e9 4 5 6 1 0 0 0\n");
  EXPECT_TRUE(read_trajectory(path_).findings.empty());
  expect_the_two("time_ms x y z qx qy qz qw\n1500 1 2 3 0 0 " + kS + " " + kS + "\n2500 4 5 6 1 0 0 0\n");
  expect_the_two("1403636579763555584 1 2 3 0 0 " + kS + " " + kS + "\n1403636579813555456 4 5 6 1 0 0 0\n",
                 1403636579.763555584);
  ASSERT_EQ(read_trajectory(path_).findings.size(), 1U);
  EXPECT_EQ(read_trajectory(path_).findings[0].text(), "its times are taken as nanoseconds");
  // Of EuRoC without its header: quaternions may begin with w.
  EXPECT_NE(error_for("1403636579763555584,1,2,3,1,0,0,0\n").find("names the columns"), std::string::npos);
}

TEST_F(PoseDialects, SquareMatricesAreReadWithTheirLastRow) {
  const std::string first = "0 -1 0 1 1 0 0 2 0 0 1 3";
  const std::string second = "1 0 0 4 0 -1 0 5 0 0 -1 6";
  expect_the_two(first + " 0 0 0 1\n" + second + " 0 0 0 1\n", std::nan(""));
  expect_the_two("r11 r12 r13 tx r21 r22 r23 ty r31 r32 r33 tz\n" + first + "\n" + second + "\n", std::nan(""));
  expect_the_two(
      "m00,m01,m02,m03,m10,m11,m12,m13,m20,m21,m22,m23,m30,m31,m32,m33\n"
      "0,-1,0,1,1,0,0,2,0,0,1,3,0,0,0,1\n1,0,0,4,0,-1,0,5,0,0,-1,6,0,0,0,1\n",
      std::nan(""));
  EXPECT_NE(error_for(first + " 0 0 1 0\n").find(":1: the last row of the 4x4 matrix"), std::string::npos);
  EXPECT_NE(error_for("r11 r21 r31 r12 r22 r32 r13 r23 r33 tx ty tz\n" + first + "\n").find(":1: 'r11"),
            std::string::npos);
  // By columns: the last row holds the position.
  EXPECT_NE(error_for("0 1 0 0 -1 0 0 0 0 0 1 0 1 2 3 1\n").find("last row"), std::string::npos);
}

TEST_F(PoseDialects, QuaternionsOfFewDigitsAreMadeToLengthOne) {
  const Trajectory trajectory = read("1 1 2 3 0 0 .71 .71\n2 1 2 3 0 0 0.7 0.71\n");
  EXPECT_TRUE(trajectory.map_from_scan[0]->isApprox(first_pose(), 1e-12));
  EXPECT_TRUE(trajectory.map_from_scan[1]->isApprox(first_pose(), 1e-2));
  EXPECT_NEAR(trajectory.map_from_scan[1]->linear().col(0).norm(), 1, 1e-12);
}

TEST_F(PoseDialects, LostPosesAreMissingAndKeepTheirTimes) {
  for (const std::string lost : {"0 0 0 0 0 0 0", "4 5 6 0 0 0 0", "nan nan nan nan nan nan nan"}) {
    const Trajectory trajectory = read("1.5 1 2 3 0 0 0 1\n2.5 " + lost + "\n3.5 1 2 3 0 0 0 1\n");
    EXPECT_EQ(trajectory.times, (std::vector<double>{1.5, 2.5, 3.5}));
    EXPECT_FALSE(trajectory.map_from_scan[1]);
    EXPECT_TRUE(trajectory.map_from_scan[2]);
  }
  EXPECT_FALSE(read("1,1,2,3,0,0,0,1\n2,,,,,,,\n").map_from_scan[1]);
  const Trajectory zeros = read("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 0\n3 0 0 0 0 0 0 0\n");
  ASSERT_EQ(zeros.findings.size(), 1U);
  EXPECT_EQ(zeros.findings[0].text(), "2 poses with a quaternion of zeros taken as missing (first: line 2)");
}

TEST_F(PoseDialects, DecimalCommasAreRefused) {
  EXPECT_NE(error_for("1,5 1,0 2,0 3,0 0,0 0,0 0,0 1,0\n").find("poses.txt:1: "), std::string::npos);
  EXPECT_NE(error_for("1,5;1,0;2,0;3,0;0,0;0,0;0,0;1,0\n").find("poses.txt:1: column 1 is '1,5'"), std::string::npos);
  EXPECT_NE(error_for("1,5\t1,0\t2,0\t3,0\t0,0\t0,0\t0,0\t1,0\n").find("poses.txt:1: "), std::string::npos);
}

TEST_F(PoseDialects, WhatIsNoTableIsRefusedAtItsFirstLine) {
  EXPECT_NE(error_for("{\n \"poses\": [\n  [1, 2, 3]]}\n").find("poses.txt:1: '{' is neither a pose nor"),
            std::string::npos);
  EXPECT_NE(error_for("header:\n  seq: 1\n").find("poses.txt:1: 'header:'"), std::string::npos);
  EXPECT_NE(error_for("Poses of a drive\n" + tum(" ")).find("poses.txt:1: 'Poses of a drive'"), std::string::npos);
  EXPECT_NE(error_for("time roll pitch yaw x y z w\n1 2 3 4 5 6 7 8\n").find("poses.txt:1: "), std::string::npos);
  EXPECT_NE(error_for("timestamp tx ty tz qx qy qz qw\n").find("holds no poses"), std::string::npos);
}

}  // namespace
}  // namespace vdbmap
