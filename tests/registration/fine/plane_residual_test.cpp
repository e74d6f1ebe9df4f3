// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/fine/plane_residual.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/random_points.h"

namespace vdbmap::registration {
namespace {

struct Problem {
  std::vector<PlaneMatch> matches;
  std::vector<double> weights;
  Eigen::Isometry3d map_from_scan;
};

Problem random_problem(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> weight(0, 1);
  Problem problem;
  problem.map_from_scan = test::random_motion(20, 130, random);
  for (int i = 0; i < 40; ++i) {
    PlaneMatch match;
    match.point = 30 * weight(random) * test::random_direction(random);
    match.mean = problem.map_from_scan * match.point + 2 * test::random_direction(random);
    match.normal = test::random_direction(random);
    problem.matches.push_back(match);
    problem.weights.push_back(weight(random));
  }
  return problem;
}

Vector6d motion_of(const Eigen::Vector3d& rotation, const Eigen::Vector3d& translation) {
  Vector6d motion;
  motion << rotation, translation;
  return motion;
}

Eigen::VectorXd residuals_at(const PlaneResiduals& residuals, const Vector6d& motion) {
  Eigen::VectorXd values(residuals.NumResiduals());
  EXPECT_TRUE(residuals(motion.data(), values.data(), nullptr));
  return values;
}

TEST(MovedBy, NothingChangesNothing) {
  const Eigen::Isometry3d pose = random_problem(1).map_from_scan;
  EXPECT_TRUE(moved_by(pose, Vector6d::Zero()).isApprox(pose, 1e-15));
}

TEST(MovedBy, TurnsAboutTheSensorAndShiftsInTheMap) {
  const Eigen::Isometry3d pose = random_problem(2).map_from_scan;
  const Eigen::Isometry3d moved = moved_by(pose, motion_of({0, 0, std::numbers::pi / 2}, {1, 2, 3}));
  EXPECT_TRUE(moved.translation().isApprox(pose.translation() + Eigen::Vector3d(1, 2, 3), 1e-14));
  // What the sensor sees a metre ahead in the map's x axis is then ahead in its y axis.
  const Eigen::Vector3d ahead = pose.linear().transpose() * Eigen::Vector3d::UnitX();
  EXPECT_TRUE((moved * ahead - moved.translation()).isApprox(Eigen::Vector3d::UnitY(), 1e-14));
}

TEST(MovedBy, AnOppositeMotionComesBack) {
  const Eigen::Isometry3d pose = random_problem(3).map_from_scan;
  const Vector6d motion = motion_of({0.4, -1.1, 0.7}, {1, -2, 0.5});
  EXPECT_TRUE(moved_by(moved_by(pose, motion), -motion).isApprox(pose, 1e-13));
}

TEST(PlaneResiduals, AreTheWeightedDistancesFromThePlanes) {
  const Problem problem = random_problem(4);
  const PlaneResiduals residuals(problem.matches, problem.weights, problem.map_from_scan);
  ASSERT_EQ(residuals.NumResiduals(), 40);
  const Vector6d motion = motion_of({0.1, 0.2, -0.3}, {1, -1, 0.5});
  const Eigen::VectorXd values = residuals_at(residuals, motion);
  const std::vector<double> distances = plane_distances(problem.matches, moved_by(problem.map_from_scan, motion));
  for (int i = 0; i < 40; ++i) EXPECT_NEAR(values[i], std::sqrt(problem.weights[i]) * distances[i], 1e-12);
}

TEST(PlaneResiduals, DistancesAreSignedAlongTheNormal) {
  PlaneMatch floor;
  floor.mean = {5, 5, 1};
  floor.normal = Eigen::Vector3d::UnitZ();
  floor.point = {1, 2, 3};
  const Eigen::Isometry3d map_from_scan(Eigen::Translation3d(0, 0, -10));
  EXPECT_DOUBLE_EQ(plane_distances(std::span(&floor, 1), map_from_scan)[0], 3 - 10 - 1);
}

class PlaneResidualsAt : public testing::TestWithParam<Vector6d> {};

TEST_P(PlaneResidualsAt, JacobianIsTheDerivative) {
  for (unsigned seed = 10; seed < 15; ++seed) {
    const Problem problem = random_problem(seed);
    const PlaneResiduals residuals(problem.matches, problem.weights, problem.map_from_scan);
    const Vector6d motion = GetParam();
    Eigen::VectorXd values(40);
    Eigen::Matrix<double, Eigen::Dynamic, 6> jacobian(40, 6);
    residuals(motion.data(), values.data(), jacobian.data());
    EXPECT_TRUE(values.isApprox(residuals_at(residuals, motion), 1e-14));

    // Central differences of 30 m arms: h^2 of the third derivative, and the rounding of 30 m over h: both below 1e-8.
    const double h = 1e-5;
    for (int i = 0; i < 6; ++i) {
      const Eigen::VectorXd forward = residuals_at(residuals, motion + h * Vector6d::Unit(i));
      const Eigen::VectorXd backward = residuals_at(residuals, motion - h * Vector6d::Unit(i));
      EXPECT_LT(((forward - backward) / (2 * h) - jacobian.col(i)).cwiseAbs().maxCoeff(), 1e-6) << "parameter " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Motions, PlaneResidualsAt,
                         testing::Values(Vector6d::Zero(), motion_of({1e-9, -2e-9, 1e-9}, {0, 0, 0}),
                                         motion_of({2e-6, 1e-6, -1e-6}, {0.1, 0, 0}),
                                         motion_of({1e-3, 0, -2e-3}, {0.1, 0.2, 0.3}),
                                         motion_of({0.1, 0.2, -0.15}, {2, -1, 0.5}),
                                         motion_of({-1.5, 2.0, 0.7}, {-20, 10, 5})));

TEST(Information, IsTheSquareOfTheWeightedJacobianAtRest) {
  const Problem problem = random_problem(20);
  const PlaneResiduals residuals(problem.matches, problem.weights, problem.map_from_scan);
  Eigen::VectorXd values(40);
  Eigen::Matrix<double, Eigen::Dynamic, 6> jacobian(40, 6);
  const Vector6d rest = Vector6d::Zero();
  residuals(rest.data(), values.data(), jacobian.data());
  const Matrix6d sum = information(problem.matches, problem.weights, problem.map_from_scan);
  EXPECT_TRUE(sum.isApprox(jacobian.transpose() * jacobian, 1e-12));
}

TEST(Information, OfNothingIsZero) {
  EXPECT_EQ(information({}, {}, Eigen::Isometry3d::Identity()), Matrix6d::Zero());
  EXPECT_TRUE(plane_distances({}, Eigen::Isometry3d::Identity()).empty());
}

}  // namespace
}  // namespace vdbmap::registration
