// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/fine/robust_rounds.h"

#include <gtest/gtest.h>

#include "registration/fine/plane_residual.h"
#include "registration/fine/scan_sample.h"
#include "tests/support/pose_distance.h"
#include "tests/support/random_points.h"
#include "tests/support/synthetic_scene.h"
#include "vdbmap/core/map_builder.h"

namespace vdbmap::registration {
namespace {

const VoxelMap& map_of_room() {
  static const VoxelMap map = [] {
    BuildOptions options;
    options.anchor = Eigen::Vector3d::Zero();
    return build_map(test::sample_scene(test::room(), 400, 1), options);
  }();
  return map;
}

Eigen::Isometry3d true_pose() {
  return Eigen::Translation3d(0.4, -0.6, 1.4) * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ());
}

std::vector<Eigen::Vector3d> room_scan() {
  return sample_points(test::scan_scene(test::room(), true_pose()).positions, 0.25, {0.5, 50});
}

MatchingStage fine_stage(std::span<const Eigen::Vector3d> points) {
  return {&map_of_room().finest(), points, {.search_voxels = 1}, {0.2, 0.1, 0.6}, 20};
}

Eigen::Isometry3d near_guess() {
  std::mt19937 random(2);
  return true_pose() * test::random_motion(0.08, 0.5, random);
}

TEST(RobustRounds, BringAScanToItsPlace) {
  const std::vector<Eigen::Vector3d> points = room_scan();
  const RoundsResult result = run_rounds(fine_stage(points), near_guess());
  EXPECT_TRUE(result.converged);
  const test::PoseDistance error = test::distance_between(result.local_from_scan, true_pose());
  EXPECT_LT(error.translation, 0.005);  // normals are off by up to 0.7 degrees over at most 7 cm, and most by less
  EXPECT_LT(error.rotation_deg, 0.05);
}

TEST(RobustRounds, RestWhereTheyConverged) {
  const std::vector<Eigen::Vector3d> points = room_scan();
  const RoundsResult first = run_rounds(fine_stage(points), near_guess());
  const RoundsResult second = run_rounds(fine_stage(points), first.local_from_scan);
  const test::PoseDistance step = test::distance_between(first.local_from_scan, second.local_from_scan);
  EXPECT_TRUE(second.converged);
  EXPECT_LT(step.translation, 2e-3);  // rest is a last step below 1 mm and 0.01 degrees; here a few rounds of it
  EXPECT_LT(step.rotation_deg, 0.02);
}

TEST(RobustRounds, WeightsBelongToTheMatchesAtTheFinalPose) {
  const std::vector<Eigen::Vector3d> points = room_scan();
  const RoundsResult result = run_rounds(fine_stage(points), near_guess());
  const std::vector<double> distances = plane_distances(result.matches, result.local_from_scan);
  ASSERT_EQ(result.weights.size(), result.matches.size());
  for (std::size_t i = 0; i < result.weights.size(); ++i) {
    const double ratio = distances[i] / 0.1;  // Geman & McClure at the last scale, times planarity
    EXPECT_NEAR(result.weights[i], result.matches[i].planarity / ((1 + ratio * ratio) * (1 + ratio * ratio)), 1e-12);
  }
}

TEST(RobustRounds, OutliersDoNotMoveTheScan) {
  std::vector<Eigen::Vector3d> points = room_scan();
  const std::size_t num_inliers = points.size();
  for (std::size_t i = 0; i < num_inliers / 4; ++i) points.push_back(points[4 * i] * (1 - 0.12 / points[4 * i].norm()));
  const RoundsResult result = run_rounds(fine_stage(points), near_guess());
  // A fifth of all points is 12 cm short. Unweighted they would move opposite walls alike but lift the scan by
  // centimetres; their weight at 0.1 m is 0.17 of an inlier's.
  EXPECT_LT(test::distance_between(result.local_from_scan, true_pose()).translation, 0.02);
}

TEST(RobustRounds, StopAtTheirLimit) {
  const std::vector<Eigen::Vector3d> points = room_scan();
  MatchingStage stage = fine_stage(points);
  stage.max_rounds = 1;
  const RoundsResult one = run_rounds(stage, near_guess());
  EXPECT_FALSE(one.converged);
  EXPECT_GT(test::distance_between(one.local_from_scan, near_guess()).translation, 0.01);
  stage.max_rounds = 0;
  EXPECT_TRUE(run_rounds(stage, near_guess()).local_from_scan.isApprox(near_guess()));
}

TEST(RobustRounds, DoNotConvergeBeforeTheLastKernel) {
  const std::vector<Eigen::Vector3d> points = room_scan();
  MatchingStage stage = fine_stage(points);
  stage.kernel = {3, 0.1, 0.9};  // 33 rounds to get down
  EXPECT_FALSE(run_rounds(stage, true_pose()).converged);
}

TEST(RobustRounds, FewerThanSixPlanesLeaveTheScanWhereItIs) {
  const std::vector<Eigen::Vector3d> points = room_scan();
  for (const std::size_t count : {0UL, 1UL, 5UL}) {
    const RoundsResult result = run_rounds(fine_stage(std::span(points).first(count)), near_guess());
    EXPECT_FALSE(result.converged);
    EXPECT_TRUE(result.local_from_scan.isApprox(near_guess(), 1e-15));
    EXPECT_EQ(result.weights.size(), result.matches.size());
  }
}

TEST(RobustRounds, AScanOutsideTheMapStaysThere) {
  const std::vector<Eigen::Vector3d> points = room_scan();
  const Eigen::Isometry3d far(Eigen::Translation3d(5000, 0, 0));
  const RoundsResult result = run_rounds(fine_stage(points), far);
  EXPECT_FALSE(result.converged);
  EXPECT_TRUE(result.matches.empty());
  EXPECT_TRUE(result.local_from_scan.isApprox(far));
}

}  // namespace
}  // namespace vdbmap::registration
