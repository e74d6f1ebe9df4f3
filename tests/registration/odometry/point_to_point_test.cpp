// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/odometry/point_to_point.h"

#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "registration/fine/scan_sample.h"
#include "tests/support/pose_distance.h"
#include "tests/support/random_points.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/threads.h"

namespace vdbmap::registration {
namespace {

// A map of a street, and a pose and points of a scan in it.
struct Problem {
  LocalMap map{LocalMapOptions{}};
  Eigen::Isometry3d map_from_scan = Eigen::Isometry3d(Eigen::Translation3d(-3, 0.4, 1.8)) *
                                    Eigen::AngleAxisd(0.4, Eigen::Vector3d(0.05, -0.02, 1).normalized());
  std::vector<Eigen::Vector3d> points;
};

Problem street_problem() {
  Problem problem;
  problem.map.insert(test::sample_scene(test::street(), 60, 1).positions);
  problem.points = sample_points(test::scan_scene(test::street(), problem.map_from_scan).positions, 1.5, {1, 100});
  return problem;
}

TEST(PointToPoint, FindsAScanFromHalfAMetreAndThreeDegrees) {
  const Problem problem = street_problem();
  std::mt19937 random(1);
  for (int i = 0; i < 5; ++i) {
    const Eigen::Isometry3d guess = problem.map_from_scan * test::random_motion(0.5, 3, random);
    const PointToPointResult result = align_points(problem.points, problem.map, guess);
    const test::PoseDistance error = test::distance_between(result.map_from_scan, problem.map_from_scan);
    // The map's points are 0.22 m and more apart, so a match is 0.1 m off; some hundred of them hold the scan.
    EXPECT_LT(error.translation, 0.05);
    EXPECT_LT(error.rotation_deg, 0.3);
    EXPECT_TRUE(result.converged);
    EXPECT_EQ(result.matches.num_inliers, problem.points.size());
  }
}

TEST(PointToPoint, TheGradientIsTheSlopeOfTheCost) {
  const Problem problem = street_problem();
  std::mt19937 random(2);
  const Eigen::Isometry3d pose = problem.map_from_scan * test::random_motion(0.2, 1, random);
  const MatchLimits limits{1, 0.1, 0.5};
  const MatchSums sums = sum_matches(problem.points, problem.map, pose, limits);
  for (int i = 0; i < 6; ++i) {
    // So small a step that no point gets another neighbour.
    const Vector6d step = 1e-7 * Vector6d::Unit(i);
    const double ahead = sum_matches(problem.points, problem.map, moved_by(pose, step), limits).cost;
    const double behind = sum_matches(problem.points, problem.map, moved_by(pose, -step), limits).cost;
    EXPECT_NEAR(sums.gradient[i], (ahead - behind) / 2e-7, 1e-4 * sums.gradient.norm()) << i;
  }
}

TEST(PointToPoint, WithoutAKernelTheInformationIsTheCurvatureOfTheCost) {
  // Points that lie on their neighbours: there the curvature has no part of second derivatives.
  Problem problem;
  problem.map.insert(test::sample_scene(test::street(), 5, 1).positions);
  for (const Eigen::Vector3d& point : problem.map.points()) {
    problem.points.emplace_back(problem.map_from_scan.inverse() * point);
  }
  const MatchLimits limits{0.05, 1e9, 0.5};
  const auto gradient_at = [&](const Vector6d& motion) {
    return sum_matches(problem.points, problem.map, moved_by(problem.map_from_scan, motion), limits).gradient;
  };
  const MatchSums sums = sum_matches(problem.points, problem.map, problem.map_from_scan, limits);
  ASSERT_EQ(sums.num_matches, problem.points.size());
  for (int i = 0; i < 6; ++i) {
    const Vector6d step = 1e-5 * Vector6d::Unit(i);
    const Vector6d column = (gradient_at(step) - gradient_at(-step)) / 2e-5;
    EXPECT_LT((sums.information.col(i) - column).norm(), 1e-4 * column.norm()) << i;
  }
}

TEST(PointToPoint, IsTheSameForAnyNumberOfThreads) {
  const Problem problem = street_problem();
  std::mt19937 random(3);
  const Eigen::Isometry3d guess = problem.map_from_scan * test::random_motion(0.5, 3, random);
  const auto align = [&] { return align_points(problem.points, problem.map, guess); };
  const PointToPointResult one = test::on_threads(1, align);
  const PointToPointResult four = test::on_threads(4, align);
  EXPECT_EQ(one.map_from_scan.matrix(), four.map_from_scan.matrix());
  EXPECT_EQ(one.num_iterations, four.num_iterations);
  EXPECT_EQ(one.matches.information, four.matches.information);
}

TEST(PointToPoint, WithoutMatchesTheGuessStays) {
  const Problem problem = street_problem();
  const Eigen::Isometry3d guess(Eigen::Translation3d(1000, 0, 0));
  for (const LocalMap& map : {problem.map, LocalMap(LocalMapOptions{})}) {
    const PointToPointResult result = align_points(problem.points, map, guess);
    EXPECT_EQ(result.map_from_scan.matrix(), guess.matrix());
    EXPECT_EQ(result.matches.num_matches, 0U);
    EXPECT_FALSE(result.converged);
  }
  EXPECT_FALSE(match_covariance(problem.points, problem.map, guess, {}));
}

TEST(PointToPoint, PointsOnOneSpotDetermineNoPose) {
  const Problem problem = street_problem();
  const std::vector<Eigen::Vector3d> points(50, problem.points.front());
  const PointToPointResult result = align_points(points, problem.map, problem.map_from_scan);
  EXPECT_TRUE(result.map_from_scan.matrix().allFinite());
  EXPECT_FALSE(match_covariance(points, problem.map, problem.map_from_scan, {}));
}

TEST(PointToPoint, RefusesLimitsThatAreNotPositive) {
  const Problem problem = street_problem();
  for (const MatchLimits& limits : {MatchLimits{0, 1, 1}, MatchLimits{1, -1, 1}, MatchLimits{1, 1, 0}}) {
    EXPECT_THROW(align_points(problem.points, problem.map, problem.map_from_scan, {limits}), std::invalid_argument);
  }
}

}  // namespace
}  // namespace vdbmap::registration
