// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/fine/joint_refinement.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/pose_distance.h"
#include "tests/support/random_points.h"

namespace vdbmap::registration {
namespace {

Matrix6d diagonal(double rotation, double translation) {
  Vector6d deviations;
  deviations << Eigen::Vector3d::Constant(rotation), Eigen::Vector3d::Constant(translation);
  return deviations.cwiseAbs2().asDiagonal();
}

Eigen::Isometry3d at(double x) { return Eigen::Isometry3d(Eigen::Translation3d(x, 0, 0)); }

TEST(JointRefinement, OfOneScanIsWhatTheMapSays) {
  std::mt19937 random(1);
  SequencePose scan;
  scan.map_from_scan_guess = test::random_motion(100, 40, random);
  scan.in_map = PoseEstimate{scan.map_from_scan_guess * test::random_motion(0.5, 3, random), diagonal(0.01, 0.02)};
  const auto poses = refine_jointly(std::vector{scan});
  const auto error = test::distance_between(poses[0].map_from_scan, scan.in_map->map_from_scan);
  EXPECT_LT(error.translation, 1e-6);
  EXPECT_LT(error.rotation_deg, 1e-5);
  // The information, and so the covariance, is that of the map's factor turned into the guess's tangent: 3 degrees.
  EXPECT_NEAR(poses[0].covariance(5, 5), 0.02 * 0.02, 1e-8);
  EXPECT_NEAR(poses[0].covariance(0, 0), 0.01 * 0.01, 5e-6);
}

// One dimension: two scans, the map says 0 and 1.3, odometry says 1: weighted least squares by hand.
TEST(JointRefinement, WeighsMapAndOdometryByTheirVariances) {
  JointOptions options;
  options.odometry_translation = 0.1;
  options.outlier_scale = 1e3;  // plain least squares but for a part in 1e6; larger scales drown in rounding
  std::vector<SequencePose> sequence(2);
  sequence[0] = {at(0), PoseEstimate{at(0), diagonal(0.001, 0.1)}, {}};
  sequence[1] = {at(1), PoseEstimate{at(1.3), diagonal(0.001, 0.2)}, at(1)};
  const auto poses = refine_jointly(sequence, options);

  // Normal equations of x0^2 / 0.01 + (x1 - 1.3)^2 / 0.04 + (x1 - x0 - 1)^2 / 0.01.
  Eigen::Matrix2d information;
  information << 100 + 100, -100, -100, 25 + 100;
  const Eigen::Vector2d x = information.inverse() * Eigen::Vector2d(-100, 25 * 1.3 + 100);
  EXPECT_NEAR(poses[0].map_from_scan.translation().x(), x[0], 1e-5);
  EXPECT_NEAR(poses[1].map_from_scan.translation().x(), x[1], 1e-5);
  const Eigen::Matrix2d covariance = information.inverse();
  EXPECT_NEAR(poses[0].covariance(3, 3), covariance(0, 0), 1e-3 * covariance(0, 0));
  EXPECT_NEAR(poses[1].covariance(3, 3), covariance(1, 1), 1e-3 * covariance(1, 1));
}

TEST(JointRefinement, CarriesAScanThatTheMapDoesNotKnow) {
  std::mt19937 random(3);
  const Eigen::Isometry3d first = test::random_motion(50, 70, random);
  const Eigen::Isometry3d step = test::random_motion(1.2, 4, random);
  std::vector<SequencePose> sequence(3);
  sequence[0] = {first, PoseEstimate{first, diagonal(0.001, 0.01)}, {}};
  sequence[1] = {first * step * test::random_motion(0.3, 2, random), {}, step};
  sequence[2] = {first * step * step, PoseEstimate{first * step * step, diagonal(0.001, 0.01)}, step};
  const auto poses = refine_jointly(sequence);
  EXPECT_LT(test::distance_between(poses[1].map_from_scan, first * step).translation, 1e-6);
  EXPECT_GT(poses[1].covariance(3, 3), poses[0].covariance(3, 3));
}

TEST(JointRefinement, ADirectionThatOneScanDoesNotKnowComesFromItsNeighbours) {
  Matrix6d along_x_unknown = diagonal(0.001, 0.01);
  along_x_unknown(3, 3) = 100;
  std::vector<SequencePose> sequence(3);
  for (int i = 0; i < 3; ++i) {
    auto& scan = sequence[static_cast<std::size_t>(i)];
    scan = {at(i), PoseEstimate{at(i), diagonal(0.001, 0.01)}, {}};
    if (i > 0) scan.previous_from_scan = at(1);
  }
  sequence[1].in_map = PoseEstimate{at(1.8), along_x_unknown};
  const auto poses = refine_jointly(sequence);
  EXPECT_NEAR(poses[1].map_from_scan.translation().x(), 1, 0.01);
}

TEST(JointRefinement, AScanThatWentAstrayDoesNotPullItsNeighbours) {
  std::vector<SequencePose> sequence(11);
  for (int i = 0; i < 11; ++i) {
    auto& scan = sequence[static_cast<std::size_t>(i)];
    scan = {at(i), PoseEstimate{at(i == 5 ? 5.8 : i), diagonal(0.002, 0.01)}, {}};
    if (i > 0) scan.previous_from_scan = at(1);
  }
  const auto poses = refine_jointly(sequence);
  for (int i = 0; i < 11; ++i) {
    EXPECT_NEAR(poses[static_cast<std::size_t>(i)].map_from_scan.translation().x(), i, 0.02) << i;
  }
}

TEST(JointRefinement, UncertaintyOfDeadReckoningGrowsWithTheRootOfTheSteps) {
  JointOptions options;
  options.odometry_rotation_deg = 1e-6;  // no turning: a plain random walk
  std::vector<SequencePose> sequence(10);
  sequence[0] = {at(0), PoseEstimate{at(0), diagonal(1e-9, 0.01)}, {}};
  for (int i = 1; i < 10; ++i) sequence[static_cast<std::size_t>(i)] = {at(i), {}, at(1)};
  const auto poses = refine_jointly(sequence, options);
  const double step = options.odometry_translation;
  EXPECT_NEAR(poses[9].covariance(4, 4), 0.01 * 0.01 + 9 * step * step, 1e-2 * 9 * step * step);
}

TEST(JointRefinement, ScansThatNothingHoldsKeepTheirGuess) {
  std::vector<SequencePose> sequence(3);
  sequence[0] = {at(0), PoseEstimate{at(0.1), diagonal(0.01, 0.01)}, {}};
  sequence[1] = {at(7), {}, {}};     // after a gap
  sequence[2] = {at(8), {}, at(1)};  // hangs on the one before alone
  const auto poses = refine_jointly(sequence);
  EXPECT_NEAR(poses[0].map_from_scan.translation().x(), 0.1, 1e-6);
  EXPECT_EQ(poses[2].map_from_scan.translation().x(), 8);
  EXPECT_GE(poses[2].covariance(3, 3), 1e6);
}

TEST(JointRefinement, OfNothingIsNothing) { EXPECT_TRUE(refine_jointly({}).empty()); }

TEST(JointRefinement, RefusesOptionsOutOfRange) {
  JointOptions options;
  options.odometry_translation = 0;
  EXPECT_THROW(refine_jointly({}, options), std::invalid_argument);
}

}  // namespace
}  // namespace vdbmap::registration
