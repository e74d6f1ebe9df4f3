// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/odometry/sensor_motion.h"

#include <gtest/gtest.h>

namespace vdbmap::registration {
namespace {

Vector6d some_twist() {
  Vector6d twist;
  twist << 0.1, -0.2, 0.5, 8, 0.3, -0.1;
  return twist;
}

Eigen::Isometry3d pose_at(double seconds) { return motion_of_twist(seconds * some_twist()); }

TEST(SensorMotion, StandsStillUntilItHasATwist) {
  SensorMotion motion;
  motion.begin_scan(0.1, 0.05);
  EXPECT_TRUE(motion.predicted_pose().isApprox(Eigen::Isometry3d::Identity(), 0));
}

TEST(SensorMotion, GoesOnFromMeanTimeToMeanTime) {
  SensorMotion motion;
  motion.begin_scan(0, 0.05);
  motion.set_pose(pose_at(0.05));
  motion.begin_scan(0.1, 0.04);
  EXPECT_TRUE(motion.twist_to(pose_at(0.14)).isApprox(some_twist(), 1e-9));
  motion.set_twist(some_twist());
  EXPECT_TRUE(motion.predicted_pose().isApprox(pose_at(0.14), 1e-9));
  EXPECT_TRUE(motion.at_first_point(motion.predicted_pose()).isApprox(pose_at(0.1), 1e-9));
}

TEST(SensorMotion, GoesOnOverScansThatAreNowhere) {
  SensorMotion motion;
  motion.begin_scan(0, 0.05);
  motion.set_pose(pose_at(0.05));
  motion.set_twist(some_twist());
  motion.begin_scan(0.1, 0.05);
  motion.begin_scan(0.3, 0);
  EXPECT_TRUE(motion.predicted_pose().isApprox(pose_at(0.4), 1e-9));
  EXPECT_TRUE(motion.twist_to(pose_at(0.4)).isApprox(some_twist(), 1e-9));
}

TEST(SensorMotion, IsFiniteForScansAtTheSameTime) {
  SensorMotion motion;
  motion.begin_scan(0.1, 0.05);
  motion.set_pose(pose_at(0));
  motion.begin_scan(0, 0.05);
  EXPECT_TRUE(motion.twist_to(pose_at(0.01)).allFinite());
}

}  // namespace
}  // namespace vdbmap::registration
