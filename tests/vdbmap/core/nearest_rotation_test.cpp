// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/nearest_rotation.h"

#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/support/random_points.h"

namespace vdbmap {
namespace {

Eigen::Matrix3d random_matrix(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Eigen::Matrix3d matrix;
  for (int column = 0; column < 3; ++column) matrix.col(column) = test::vector_of([&] { return normal(random); });
  return matrix;
}

TEST(NearestRotation, OfARotationIsItself) {
  std::mt19937 random(1);
  for (int i = 0; i < 10; ++i) {
    const Eigen::Matrix3d rotation = test::random_motion(0, 18.0 * i, random).linear();
    EXPECT_TRUE(nearest_rotation(3 * rotation).isApprox(rotation, 1e-12)) << i;
  }
}

TEST(NearestRotation, NoOtherRotationIsNearer) {
  std::mt19937 random(2);
  for (int i = 0; i < 20; ++i) {  // half of such matrices mirror
    const Eigen::Matrix3d matrix = random_matrix(random);
    const Eigen::Matrix3d nearest = nearest_rotation(matrix);
    EXPECT_NEAR(nearest.determinant(), 1, 1e-12);
    EXPECT_TRUE((nearest.transpose() * nearest).isIdentity(1e-12));
    for (int k = 0; k < 200; ++k) {
      const double angle_deg = k % 2 == 0 ? 1 : 180.0 * k / 200;
      const Eigen::Matrix3d other = test::random_motion(0, angle_deg, random).linear() * nearest;
      EXPECT_GE((other - matrix).norm(), (nearest - matrix).norm() - 1e-12);
    }
  }
}

TEST(NearestRotation, OfMatchedPointsTurnsSourcesToTargets) {
  std::mt19937 random(3);
  const Eigen::Matrix3d target_from_source = test::random_motion(0, 70, random).linear();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 10; ++i) {
    const Eigen::Vector3d source(i, 2.0 * (i % 3), 0);  // in a plane: its mirror image fits as well
    products += target_from_source * source * source.transpose();
  }
  EXPECT_TRUE(nearest_rotation(products).isApprox(target_from_source, 1e-9));
}

}  // namespace
}  // namespace vdbmap
