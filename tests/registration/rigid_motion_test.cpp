// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/rigid_motion.h"

#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <unsupported/Eigen/MatrixFunctions>

#include "tests/support/random_points.h"

namespace vdbmap::registration {
namespace {

Vector6d random_twist(double angle, double distance, std::mt19937& random) {
  Vector6d twist;
  twist << angle * test::random_direction(random), distance * test::random_direction(random);
  return twist;
}

TEST(RigidMotion, OfATwistIsTheMatrixExponential) {
  std::mt19937 random(1);
  for (const double angle : {0.0, 1e-9, 1e-7, 2e-6, 1e-3, 0.1, 1.0, 3.0}) {
    const Vector6d twist = random_twist(angle, 5, random);
    Eigen::Matrix4d generator = Eigen::Matrix4d::Zero();
    generator.topLeftCorner<3, 3>() = cross_matrix(twist.head<3>());
    generator.topRightCorner<3, 1>() = twist.tail<3>();
    const Eigen::Matrix4d expected = generator.exp();
    // Differences of cosines near 1 keep ten digits.
    EXPECT_TRUE(motion_of_twist(twist).matrix().isApprox(expected, 1e-10)) << angle;
  }
}

TEST(RigidMotion, TheTwistOfAMotionLeadsBackToIt) {
  std::mt19937 random(2);
  for (const double angle : {0.0, 1e-9, 1e-7, 2e-6, 1e-3, 0.1, 1.0, 3.0}) {
    const Vector6d twist = random_twist(angle, 5, random);
    EXPECT_TRUE(twist_of_motion(motion_of_twist(twist)).isApprox(twist, 1e-10)) << angle;
  }
}

TEST(RigidMotion, ATurnOverByHalfATurnKeepsItsLength) {
  const Eigen::Isometry3d motion(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d(1, 2, 3).normalized()));
  EXPECT_NEAR(twist_of_motion(motion).head<3>().norm(), std::numbers::pi, 1e-9);
}

// Each pose predicted from the two before and moved a little, as odometry does: unchecked, rounding errors of the
// rotation double from pose to pose and reach 1 after fifty.
TEST(RigidMotion, AChainOfPredictedAndMovedPosesStaysRigid) {
  std::mt19937 random(3);
  Eigen::Isometry3d before = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d last = motion_of_twist(random_twist(0.05, 1, random));
  for (int i = 0; i < 500; ++i) {
    const Eigen::Isometry3d predicted = last * (before.inverse() * last);
    before = last;
    last = moved_by(predicted, random_twist(0.01, 0.1, random));
    ASSERT_TRUE((last.linear().transpose() * last.linear()).isIdentity(1e-13)) << i;
  }
}

}  // namespace
}  // namespace vdbmap::registration
