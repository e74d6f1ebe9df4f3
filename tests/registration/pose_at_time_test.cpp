// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/pose_at_time.h"

#include <gtest/gtest.h>

#include "registration/rigid_motion.h"
#include "tests/support/pose_distance.h"

namespace vdbmap::registration {
namespace {

Vector6d twist_of(const Eigen::Vector3d& turn, const Eigen::Vector3d& velocity) {
  Vector6d twist;
  twist << turn, velocity;
  return twist;
}

void expect_near(const Eigen::Isometry3d& found, const Eigen::Isometry3d& expected) {
  const auto distance = test::distance_between(found, expected);
  EXPECT_LT(distance.translation, 1e-9);
  EXPECT_LT(distance.rotation_deg, 1e-6);
}

TEST(PoseAtTime, FollowsAConstantTwist) {
  const Vector6d twist = twist_of({0.1, -0.2, 0.7}, {8, 0.3, -0.2});
  const Eigen::Isometry3d start(Eigen::Translation3d(500, 600, 70) * Eigen::AngleAxisd(1, Eigen::Vector3d::UnitZ()));
  const auto at = [&](double time) { return TimedPose{time, start * motion_of_twist(time * twist)}; };
  const Eigen::Isometry3d expected = at(0.15).map_from_sensor;
  expect_near(pose_at_time(0.15, at(0.08), at(0.2), at(0.31)), expected);
  expect_near(pose_at_time(0.15, at(0.08), at(0.2), std::nullopt), expected);
  expect_near(pose_at_time(0.15, std::nullopt, at(0.2), at(0.31)), expected);
}

TEST(PoseAtTime, FollowsAConstantAcceleration) {
  const auto at = [](double time) {
    const Eigen::Vector3d position(8 * time + 1.5 * time * time, 0, 0.4 * time - 2 * time * time);
    return TimedPose{time, Eigen::Isometry3d(Eigen::Translation3d(position))};
  };
  expect_near(pose_at_time(0.15, at(0.1), at(0.2), at(0.33)), at(0.15).map_from_sensor);
}

TEST(PoseAtTime, FollowsATurnThatQuickens) {
  const auto at = [](double time) {
    return TimedPose{time,
                     Eigen::Isometry3d(Eigen::AngleAxisd(0.3 * time + 2 * time * time, Eigen::Vector3d::UnitY()))};
  };
  expect_near(pose_at_time(0.15, at(0.1), at(0.2), at(0.3)), at(0.15).map_from_sensor);
}

TEST(TwistAtPose, IsTheOneThatThePosesFollow) {
  const Vector6d twist = twist_of({0.1, -0.2, 0.7}, {8, 0.3, -0.2});
  const auto at = [&](double time) { return TimedPose{time, motion_of_twist(time * twist)}; };
  EXPECT_TRUE(twist_at_pose(at(0.08), at(0.2), at(0.31)).isApprox(twist, 1e-9));
  EXPECT_TRUE(twist_at_pose(at(0.08), at(0.2), std::nullopt).isApprox(twist, 1e-9));
  EXPECT_TRUE(twist_at_pose(std::nullopt, at(0.2), at(0.31)).isApprox(twist, 1e-9));
}

TEST(TwistAtPose, IsThatOfTheMomentWhereItChanges) {
  const auto at = [](double time) {
    return TimedPose{time, Eigen::Isometry3d(Eigen::Translation3d(8 * time + 1.5 * time * time, 0, 0))};
  };
  EXPECT_TRUE(twist_at_pose(at(0.1), at(0.2), at(0.33)).isApprox(twist_of({0, 0, 0}, {8 + 3 * 0.2, 0, 0}), 1e-9));
}

TEST(PoseAtTime, NeedsANeighbourInTheOrderOfTime) {
  const TimedPose at{5, Eigen::Isometry3d::Identity()};
  EXPECT_THROW(pose_at_time(4.9, std::nullopt, at, std::nullopt), std::invalid_argument);
  EXPECT_THROW(pose_at_time(4.9, at, at, std::nullopt), std::invalid_argument);
  EXPECT_THROW(pose_at_time(4.9, std::nullopt, at, TimedPose{4, Eigen::Isometry3d::Identity()}), std::invalid_argument);
}

}  // namespace
}  // namespace vdbmap::registration
