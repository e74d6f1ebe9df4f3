// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/evaluation/trajectory_alignment.h"

#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "registration/trajectory_error.h"
#include "tests/support/pose_distance.h"
#include "tests/support/random_points.h"

namespace vdbmap::registration {
namespace {

Trajectory trajectory_of(const std::vector<Eigen::Vector3d>& positions) {
  Trajectory trajectory;
  for (const Eigen::Vector3d& position : positions) {
    trajectory.map_from_scan.emplace_back(Eigen::Translation3d(position) * Eigen::Isometry3d::Identity());
  }
  return trajectory;
}

std::vector<Eigen::Vector3d> positions_in_a_box(std::size_t count, unsigned seed) {
  return test::random_points(count, {Eigen::Vector3d(-50, -20, -2), Eigen::Vector3d(50, 20, 2)}, seed);
}

double rms_after_alignment(const Trajectory& estimate, const Trajectory& truth) {
  return evaluate_trajectory(moved(estimate, *align_trajectory(estimate, truth)), truth).translation.rms;
}

TEST(TrajectoryAlignment, FindsAMotionExactly) {
  std::mt19937 random(1);
  const Trajectory truth = trajectory_of(positions_in_a_box(40, 2));
  for (const double angle_deg : {0.0, 1.0, 90.0, 180.0}) {
    const Eigen::Isometry3d estimate_from_truth = test::random_motion(30, angle_deg, random);
    const auto found = align_trajectory(moved(truth, estimate_from_truth), truth);

    ASSERT_TRUE(found.has_value());
    const auto distance = test::distance_between(*found, estimate_from_truth.inverse());
    EXPECT_LT(distance.translation, 1e-12 * 100);
    EXPECT_LT(distance.rotation_deg, 1e-10);
  }
}

TEST(TrajectoryAlignment, AgreesWithEigensUmeyama) {
  const std::vector<Eigen::Vector3d> truth = positions_in_a_box(25, 3);
  std::vector<Eigen::Vector3d> estimate = positions_in_a_box(25, 4);
  for (std::size_t i = 0; i < truth.size(); ++i) estimate[i] = truth[i] + 0.2 * estimate[i];
  Eigen::MatrixXd source(3, 25);
  Eigen::MatrixXd target(3, 25);
  for (int i = 0; i < 25; ++i) {
    source.col(i) = estimate[static_cast<std::size_t>(i)];
    target.col(i) = truth[static_cast<std::size_t>(i)];
  }
  const Eigen::Matrix4d expected = Eigen::umeyama(source, target, false);

  EXPECT_TRUE(align_trajectory(trajectory_of(estimate), trajectory_of(truth))->matrix().isApprox(expected, 1e-12));
}

TEST(TrajectoryAlignment, KeepsTheScale) {
  // Ends of a cross, 1 m from its middle, estimated a tenth too far out: what remains is 0.1 m everywhere.
  const std::vector<Eigen::Vector3d> cross = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
  std::vector<Eigen::Vector3d> larger;
  for (const Eigen::Vector3d& position : cross) larger.emplace_back(1.1 * position + Eigen::Vector3d(5, 6, 7));
  EXPECT_NEAR(rms_after_alignment(trajectory_of(larger), trajectory_of(cross)), 0.1, 1e-12);
}

TEST(TrajectoryAlignment, NoNeighbouringMotionIsBetter) {
  std::mt19937 random(5);
  const Trajectory truth = trajectory_of(positions_in_a_box(20, 6));
  const Trajectory estimate = trajectory_of(positions_in_a_box(20, 7));
  const Trajectory aligned = moved(estimate, *align_trajectory(estimate, truth));
  const double best = evaluate_trajectory(aligned, truth).translation.rms;
  for (int i = 0; i < 50; ++i) {
    const Trajectory other = moved(aligned, test::random_motion(0.01, 0.01, random));
    EXPECT_GT(evaluate_trajectory(other, truth).translation.rms, best);
  }
}

TEST(TrajectoryAlignment, NeverMirrors) {
  const std::vector<Eigen::Vector3d> truth = positions_in_a_box(20, 8);
  std::vector<Eigen::Vector3d> mirrored = truth;
  for (Eigen::Vector3d& position : mirrored) position.y() = -position.y();
  EXPECT_NEAR(align_trajectory(trajectory_of(mirrored), trajectory_of(truth))->linear().determinant(), 1, 1e-12);
}

TEST(TrajectoryAlignment, AStraightLineIsAlignedThoughItsRollIsNot) {
  std::vector<Eigen::Vector3d> line;
  for (int i = 0; i < 10; ++i) line.emplace_back(i, 2.0 * i, 0);
  std::mt19937 random(9);
  const Trajectory truth = trajectory_of(line);
  EXPECT_LT(rms_after_alignment(moved(truth, test::random_motion(3, 40, random)), truth), 1e-12 * 100);
}

TEST(TrajectoryAlignment, CountsOnlyScansWithBothPoses) {
  std::mt19937 random(10);
  Trajectory truth = trajectory_of(positions_in_a_box(10, 11));
  Trajectory estimate = moved(truth, test::random_motion(30, 20, random));
  estimate.map_from_scan[3]->translation() += Eigen::Vector3d(100, 0, 0);
  truth.map_from_scan[3].reset();
  estimate.map_from_scan[5].reset();
  EXPECT_LT(rms_after_alignment(estimate, truth), 1e-12 * 100);
}

TEST(TrajectoryAlignment, TwoPosesDetermineNothing) {
  const Trajectory two = trajectory_of({{0, 0, 0}, {1, 0, 0}});
  EXPECT_FALSE(align_trajectory(two, two).has_value());
  EXPECT_THROW(align_trajectory(two, {}), std::invalid_argument);
}

}  // namespace
}  // namespace vdbmap::registration
