// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/eigen_features.h"

#include <cmath>
#include <random>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/support/random_points.h"

namespace vdbmap {
namespace {

// The covariance with these eigenvalues whose eigenvectors are the columns of a rotation.
Eigen::Matrix3d covariance_with(const Eigen::Vector3d& eigenvalues, const Eigen::Matrix3d& rotation) {
  return rotation * eigenvalues.asDiagonal() * rotation.transpose();
}

Eigen::Matrix3d random_rotation(std::mt19937& random) { return test::random_motion(0, 77, random).linear(); }

TEST(EigenFeatures, OfALineAreLinear) {
  const EigenFeatures features = eigen_features(Eigen::Vector3d(0, 0, 4).asDiagonal().toDenseMatrix());
  EXPECT_EQ(features.eigenvalues, Eigen::Vector3d(4, 0, 0));
  EXPECT_DOUBLE_EQ(features.linearity, 1);
  EXPECT_DOUBLE_EQ(features.planarity, 0);
  EXPECT_DOUBLE_EQ(features.scattering, 0);
  EXPECT_DOUBLE_EQ(features.anisotropy, 1);
  EXPECT_DOUBLE_EQ(features.eigenentropy, 0);
  EXPECT_DOUBLE_EQ(features.omnivariance, 0);
  EXPECT_DOUBLE_EQ(features.verticality, 1);  // the normal of an upright line is level
}

TEST(EigenFeatures, OfAPlaneArePlanar) {
  const EigenFeatures features = eigen_features(Eigen::Vector3d(2, 2, 0).asDiagonal().toDenseMatrix());
  EXPECT_DOUBLE_EQ(features.linearity, 0);
  EXPECT_DOUBLE_EQ(features.planarity, 1);
  EXPECT_DOUBLE_EQ(features.scattering, 0);
  EXPECT_DOUBLE_EQ(features.surface_variation, 0);
  EXPECT_DOUBLE_EQ(features.eigenentropy, std::log(2));
  EXPECT_DOUBLE_EQ(features.verticality, 0);
}

TEST(EigenFeatures, OfABallAreScattered) {
  const EigenFeatures features = eigen_features(0.01 * Eigen::Matrix3d::Identity());
  EXPECT_DOUBLE_EQ(features.linearity, 0);
  EXPECT_DOUBLE_EQ(features.planarity, 0);
  EXPECT_DOUBLE_EQ(features.scattering, 1);
  EXPECT_DOUBLE_EQ(features.anisotropy, 0);
  EXPECT_DOUBLE_EQ(features.omnivariance, 0.01);
  EXPECT_DOUBLE_EQ(features.eigenentropy, std::log(3));
  EXPECT_DOUBLE_EQ(features.surface_variation, 1.0 / 3);
}

TEST(EigenFeatures, OfNoExtentAreZero) {
  const EigenFeatures features = eigen_features(Eigen::Matrix3d::Zero());
  EXPECT_EQ(features.eigenvalues, Eigen::Vector3d::Zero());
  for (const double value :
       {features.linearity, features.planarity, features.scattering, features.omnivariance, features.anisotropy,
        features.eigenentropy, features.surface_variation, features.verticality}) {
    EXPECT_EQ(value, 0);
  }
}

TEST(EigenFeatures, FollowTheirFormulasInAnyRotation) {
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Matrix3d rotation = random_rotation(random);
    const EigenFeatures features = eigen_features(covariance_with({0.5, 0.3, 0.2}, rotation));
    const double rounding = 1e-13;
    EXPECT_TRUE(features.eigenvalues.isApprox(Eigen::Vector3d(0.5, 0.3, 0.2), rounding));
    EXPECT_NEAR(features.linearity, 0.4, rounding);
    EXPECT_NEAR(features.planarity, 0.2, rounding);
    EXPECT_NEAR(features.scattering, 0.4, rounding);
    EXPECT_NEAR(features.omnivariance, std::cbrt(0.03), rounding);
    EXPECT_NEAR(features.anisotropy, 0.6, rounding);
    EXPECT_NEAR(features.eigenentropy, -(0.5 * std::log(0.5) + 0.3 * std::log(0.3) + 0.2 * std::log(0.2)), rounding);
    EXPECT_NEAR(features.surface_variation, 0.2, rounding);
    EXPECT_NEAR(features.verticality, 1 - std::abs(rotation(2, 2)), rounding);
  }
}

TEST(EigenFeatures, RoundingBelowZeroIsNoEigenvalue) {
  Eigen::Matrix3d covariance = Eigen::Vector3d(1, 1, -1e-9).asDiagonal();
  EXPECT_EQ(eigen_features(covariance).eigenvalues[2], 0);
  EXPECT_EQ(eigen_features(covariance).scattering, 0);
  EXPECT_FALSE(std::isnan(eigen_features(covariance).eigenentropy));
}

TEST(PlaneFit, FindsTheNormalOfATiltedPlane) {
  std::mt19937 random(2);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Matrix3d rotation = random_rotation(random);
    const PlaneFit plane = fit_plane(covariance_with({0.004, 0.002, 0}, rotation));
    EXPECT_NEAR(std::abs(plane.normal.dot(rotation.col(2))), 1, 1e-12);
    EXPECT_NEAR(plane.planarity, 0.5, 1e-9);
  }
}

TEST(PlaneFit, NormalsPointUpwards) {
  std::mt19937 random(3);
  for (int i = 0; i < 1000; ++i) {
    const PlaneFit plane = fit_plane(covariance_with({0.004, 0.002, 1e-6}, random_rotation(random)));
    EXPECT_GE(plane.normal.z(), 0);
    EXPECT_NEAR(plane.normal.norm(), 1, 1e-12);
  }
}

TEST(PlaneFit, NormalsOfUprightWallsPointToPositiveXThenY) {
  for (int angle_deg = 0; angle_deg < 360; angle_deg += 15) {
    const Eigen::Matrix3d rotation =
        Eigen::AngleAxisd(angle_deg * EIGEN_PI / 180, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const Eigen::Vector3d normal = fit_plane(covariance_with({0, 0.003, 0.002}, rotation)).normal;
    EXPECT_NEAR(std::abs(normal.dot(rotation.col(0))), 1, 1e-12);
    EXPECT_TRUE(normal.x() > 1e-6 || (normal.x() > -1e-6 && normal.y() > 0)) << angle_deg << ": " << normal.transpose();
  }
}

TEST(PlaneFit, WithoutExtentIsLevelAndNotFlat) {
  const PlaneFit plane = fit_plane(Eigen::Matrix3d::Zero());
  EXPECT_EQ(plane.normal, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(plane.planarity, 0);
}

TEST(PlaneFit, LinesAndBallsAreNotFlat) {
  EXPECT_NEAR(fit_plane(Eigen::Vector3d(1, 1e-9, 1e-9).asDiagonal().toDenseMatrix()).planarity, 0, 1e-9);
  EXPECT_NEAR(fit_plane(0.02 * Eigen::Matrix3d::Identity()).planarity, 0, 1e-7);
}

TEST(PlaneFit, AgreesWithTheIterativeSolver) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> share(0, 1);
  for (int i = 0; i < 20'000; ++i) {
    const double scale = std::pow(10, -8 * share(random));  // [m^2] from a metre to a tenth of a millimetre
    const double l2 = share(random);
    const double l3 = l2 * share(random);
    const Eigen::Matrix3d covariance = scale * covariance_with({1, l2, l3}, random_rotation(random));
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> iterative(covariance);
    const Eigen::Vector3d values = iterative.eigenvalues();

    // The closed form takes roots of a cubic: half the digits where two eigenvalues meet.
    const PlaneFit plane = fit_plane(covariance);
    EXPECT_NEAR(plane.planarity, (values[1] - values[0]) / values[2], 1e-7);
    if (plane.planarity < 0.01) continue;  // no direction to compare
    EXPECT_LT(plane.normal.cross(iterative.eigenvectors().col(0)).norm(), 1e-6) << covariance;
  }
}

}  // namespace
}  // namespace vdbmap
