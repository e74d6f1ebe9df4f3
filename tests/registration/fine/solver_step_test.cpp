// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/fine/solver_step.h"

#include <numbers>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "registration/fine/plane_residual.h"

namespace vdbmap::registration {
namespace {

// Holds the place of the sensor, and with `levers` its attitude too: points on the axes in planes at right angles.
std::vector<PlaneMatch> pinned_sensor(double levers) {
  std::vector<PlaneMatch> matches;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d normal = Eigen::Vector3d::Unit(axis);
    for (int i = 0; i < 200; ++i) matches.push_back({Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), normal, 1});
    const Eigen::Vector3d point = levers * Eigen::Vector3d::Unit((axis + 1) % 3);
    if (levers > 0) matches.push_back({point, point, normal, 1});
  }
  return matches;
}

// A point a metre from the sensor, turned by 80 degrees already, that a plane half a metre beyond its reach pulls
// round: the residual is sin(angle) - 1.5, so flat there that a step of Gauss and Newton goes round by 170 degrees
// more, where it is worse.
struct Overshoot {
  std::vector<PlaneMatch> matches = pinned_sensor(0);
  std::vector<double> weights;
  Eigen::Isometry3d pose{Eigen::AngleAxisd(80 * std::numbers::pi / 180, Eigen::Vector3d::UnitZ())};

  Overshoot() {
    matches.push_back({{1, 0, 0}, {0, 1.5, 0}, {0, 1, 0}, 1});
    weights.assign(matches.size(), 1.0);
  }
};

double sum_of_squares(const std::vector<PlaneMatch>& matches, const std::vector<double>& weights,
                      const Eigen::Isometry3d& pose) {
  const std::vector<double> distances = plane_distances(matches, pose);
  double sum = 0;
  for (std::size_t i = 0; i < distances.size(); ++i) sum += weights[i] * distances[i] * distances[i];
  return sum;
}

TEST(SolverStep, IsThatOfGaussAndNewton) {
  std::vector<PlaneMatch> matches = pinned_sensor(10);
  const std::vector<double> weights(matches.size(), 0.7);
  Vector6d off;
  off << 0.002, -0.001, 0.003, 0.05, -0.02, 0.04;
  const Eigen::Isometry3d pose = moved_by(Eigen::Isometry3d::Identity(), off);
  const std::vector<double> distances = plane_distances(matches, pose);
  Vector6d gradient = Vector6d::Zero();
  for (std::size_t i = 0; i < matches.size(); ++i) {
    gradient += weights[i] * distances[i] * sensitivity_to_motion(matches[i], pose);
  }
  const Vector6d expected = -information(matches, weights, pose).ldlt().solve(gradient);

  const SolverStep step = step_towards_planes(matches, weights, pose);
  EXPECT_FALSE(step.was_rejected);
  EXPECT_EQ(step.motion, step.proposed);
  EXPECT_LT((step.motion - expected).norm(), 1e-3 * expected.norm());  // the trust region damps by 1e-4
}

TEST(SolverStep, OneThatMakesThingsWorseIsDampedUntilItDoesNot) {
  const Overshoot problem;
  const SolverStep step = step_towards_planes(problem.matches, problem.weights, problem.pose);
  ASSERT_TRUE(step.was_rejected);
  EXPECT_GT(step.proposed.norm(), 1);
  EXPECT_GT(sum_of_squares(problem.matches, problem.weights, moved_by(problem.pose, step.proposed)),
            sum_of_squares(problem.matches, problem.weights, problem.pose));
  EXPECT_LT(sum_of_squares(problem.matches, problem.weights, moved_by(problem.pose, step.motion)),
            sum_of_squares(problem.matches, problem.weights, problem.pose));
}

TEST(SolverStep, InTheMinimumIsNone) {
  const std::vector<PlaneMatch> matches = pinned_sensor(10);
  const std::vector<double> weights(matches.size(), 1.0);
  const SolverStep step = step_towards_planes(matches, weights, Eigen::Isometry3d::Identity());
  EXPECT_FALSE(step.was_rejected);
  EXPECT_TRUE(step.proposed.isZero(0));
  EXPECT_TRUE(step.motion.isZero(0));
}

TEST(SolverStep, OfMatchesWithoutWeightIsNone) {
  const std::vector<PlaneMatch> matches = pinned_sensor(10);
  const std::vector<double> weights(matches.size(), 0.0);
  const SolverStep step = step_towards_planes(matches, weights, Eigen::Isometry3d(Eigen::Translation3d(0.1, 0, 0)));
  EXPECT_TRUE(step.motion.isZero(0));
}

}  // namespace
}  // namespace vdbmap::registration
