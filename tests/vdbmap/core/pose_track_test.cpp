// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/pose_track.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

namespace vdbmap {
namespace {

using Poses = std::vector<std::optional<Eigen::Isometry3d>>;

Eigen::Isometry3d pose(double x, double yaw) {
  Eigen::Isometry3d made = Eigen::Isometry3d::Identity();
  made.translation().x() = x;
  made.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return made;
}

TEST(PoseTrack, APointOnACircleTurnsEvenly) {
  const PoseTrack track({pose(0, 0), pose(10, std::numbers::pi / 2)}, {100, 101});
  const Eigen::Isometry3d middle = track.at(100.25).value();
  EXPECT_NEAR(middle.translation().x(), 2.5, 1e-12);
  EXPECT_TRUE(middle.linear().isApprox(pose(0, std::numbers::pi / 8).linear(), 1e-12));
}

TEST(PoseTrack, PosesAreSortedAndMissingOnesPassedOver) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const PoseTrack track({pose(4, 0), std::nullopt, pose(7, 0), pose(0, 0)}, {2, 1, nan, 0});
  EXPECT_NEAR(track.at(1, 5).value().translation().x(), 2, 1e-12);
  EXPECT_NEAR(track.at(2, 5).value().translation().x(), 4, 1e-12);
  EXPECT_NEAR(track.at(0, 5).value().translation().x(), 0, 1e-12);
}

TEST(PoseTrack, NothingIsSaidOutsideAndInGaps) {
  const PoseTrack track({pose(0, 0), pose(1, 0), pose(9, 0)}, {0, 0.5, 4});
  EXPECT_FALSE(track.at(-1e-9));
  EXPECT_FALSE(track.at(4.1));
  EXPECT_FALSE(track.at(2));
  EXPECT_TRUE(track.at(0.4));
  EXPECT_FALSE(track.at(std::numeric_limits<double>::quiet_NaN()));
}

TEST(PoseTrack, WhatIsNoTrajectoryIsRefused) {
  EXPECT_THROW(PoseTrack({pose(0, 0)}, {0}), std::invalid_argument);
  EXPECT_THROW(PoseTrack(Poses{pose(0, 0), pose(1, 0)}, {0}), std::invalid_argument);
  EXPECT_THROW(PoseTrack({pose(0, 0), pose(1, 0)}, {3, 3}), std::invalid_argument);
  EXPECT_NO_THROW(PoseTrack({pose(0, 0), pose(0, 0), pose(1, 0)}, {3, 3, 4}));
}

}  // namespace
}  // namespace vdbmap
