// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/evaluation/relative_error.h"

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "registration/evaluation/trajectory_alignment.h"
#include "tests/support/pose_distance.h"
#include "tests/support/random_points.h"

namespace vdbmap::registration {
namespace {

constexpr double kDegPerRad = 180 / std::numbers::pi;

// Scans `step` apart along x; the estimate makes `scale` of the way and turns by `turn` [rad] a scan about z.
Trajectory straight(std::size_t count, double step, double scale = 1, double turn = 0) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < count; ++i) {
    const auto number = static_cast<double>(i);
    trajectory.map_from_scan.emplace_back(Eigen::Translation3d(scale * step * number, 0, 0) *
                                          Eigen::AngleAxisd(turn * number, Eigen::Vector3d::UnitZ()));
  }
  return trajectory;
}

TEST(RelativeError, AScaledTrajectoryDriftsByItsScale) {
  // Segments of 0.5 m steps reach just beyond 10 m: 10.5 m, of which a hundredth is lost.
  const std::vector<double> lengths = {10};
  const auto errors = relative_errors(straight(101, 0.5, 0.99), straight(101, 0.5), lengths);

  ASSERT_EQ(errors.size(), 1U);
  EXPECT_EQ(errors[0].num_segments, 101U - 21U);
  EXPECT_NEAR(errors[0].driven, 10.5, 1e-12);
  EXPECT_NEAR(errors[0].translation.mean, 0.105, 1e-12);
  EXPECT_NEAR(errors[0].translation.max, 0.105, 1e-12);
  EXPECT_NEAR(errors[0].translation_percent(), 1.05, 1e-10);
  EXPECT_NEAR(errors[0].rotation_deg.max, 0, 1e-12);
}

TEST(RelativeError, ATurningTrajectoryDriftsByItsTurn) {
  // Every estimated scan is turned a little more, its place is right: the segment's end, seen from its turned start,
  // lies off by a chord of twice the sine of half the turn of the start.
  const double turn = 0.001;
  const std::vector<double> lengths = {4};
  const auto errors = relative_errors(straight(11, 1, 1, turn), straight(11, 1), lengths);

  ASSERT_EQ(errors[0].num_segments, 6U);
  EXPECT_NEAR(errors[0].rotation_deg.mean, 5 * turn * kDegPerRad, 1e-10);
  EXPECT_NEAR(errors[0].rotation_deg_per_m(), 5 * turn * kDegPerRad / 4, 1e-10);
  EXPECT_NEAR(errors[0].translation.max, 2 * 5 * std::sin(5 * turn / 2), 1e-12);
}

TEST(RelativeError, DoesNotSeeWhereAndHowTheWholeTrajectoryLies) {
  std::mt19937 random(1);
  const Trajectory truth = straight(50, 0.7);
  const auto errors = relative_errors(moved(truth, test::random_motion(1000, 120, random)), truth, kShortLengths);
  ASSERT_EQ(errors.size(), 3U);  // the way is 34 m long
  for (const RelativeError& error : errors) {
    EXPECT_LT(error.translation.max, 1e-12 * 1000);
    EXPECT_LT(error.rotation_deg.max, 1e-10);
  }
}

// As written in KITTI's paper, pair by pair.
TEST(RelativeError, AgreesWithTheDefinitionTermByTerm) {
  std::mt19937 random(2);
  Trajectory truth;
  Trajectory estimate;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 300; ++i) {
    truth.map_from_scan.emplace_back(pose);
    estimate.map_from_scan.emplace_back(pose * test::random_motion(0.2, 1, random));
    pose = pose * test::random_motion(1.3, 4, random);
  }
  const std::vector<double> lengths = {100, 200};
  const auto errors = relative_errors(estimate, truth, lengths, kKittiStartStep);

  double percent = 0;
  double deg_per_m = 0;
  std::size_t count = 0;
  for (std::size_t first = 0; first < 300; first += 10) {
    for (const double length : lengths) {
      std::size_t last = first;
      double way = 0;
      while (last + 1 < 300 && way <= length) {
        way += (truth.map_from_scan[last + 1]->translation() - truth.map_from_scan[last]->translation()).norm();
        ++last;
      }
      if (way <= length) continue;
      const Eigen::Isometry3d error =
          (estimate.map_from_scan[first]->inverse() * *estimate.map_from_scan[last]).inverse() *
          (truth.map_from_scan[first]->inverse() * *truth.map_from_scan[last]);
      percent += 100 * error.translation().norm() / length;
      deg_per_m += test::distance_between(error, Eigen::Isometry3d::Identity()).rotation_deg / length;
      ++count;
    }
  }
  const KittiScore score = kitti_score(errors);
  ASSERT_EQ(score.num_segments, count);
  EXPECT_NEAR(score.translation_percent, percent / static_cast<double>(count), 1e-10);
  EXPECT_NEAR(score.rotation_deg_per_m, deg_per_m / static_cast<double>(count), 1e-10);
}

TEST(RelativeError, SegmentsWithoutAnEstimateAreCounted) {
  Trajectory estimate = straight(20, 1);
  estimate.map_from_scan[10].reset();
  const std::vector<double> lengths = {4.5};  // five steps: 10 ends one segment and starts another
  const auto errors = relative_errors(estimate, straight(20, 1), lengths);
  EXPECT_EQ(errors[0].num_missing, 2U);
  EXPECT_EQ(errors[0].num_segments, 13U);
}

TEST(RelativeError, TheTruePathRunsOverScansWithoutAPose) {
  Trajectory truth = straight(20, 1);
  truth.map_from_scan[3].reset();
  const std::vector<double> lengths = {4.5};
  const auto errors = relative_errors(straight(20, 1), truth, lengths);
  EXPECT_EQ(errors[0].num_segments, 14U);  // of 15, one would start at 3, another ends at 4 or later
  EXPECT_NEAR(errors[0].translation.max, 0, 1e-12);
}

TEST(RelativeError, WaysTooShortAndStandingStillHaveNoSegment) {
  EXPECT_TRUE(relative_errors(straight(50, 0), straight(50, 0), kShortLengths).empty());
  EXPECT_TRUE(relative_errors(straight(1, 1), straight(1, 1), kShortLengths).empty());
  EXPECT_TRUE(relative_errors({}, {}, kShortLengths).empty());
  EXPECT_TRUE(std::isnan(kitti_score({}).translation_percent));
}

TEST(RelativeError, WrongArgumentsAreRefused) {
  const Trajectory two = straight(2, 1);
  EXPECT_THROW(relative_errors(two, {}, kShortLengths), std::invalid_argument);
  EXPECT_THROW(relative_errors(two, two, kShortLengths, 0), std::invalid_argument);
  for (const double length : {0.0, -1.0, std::nan("")}) {
    EXPECT_THROW(relative_errors(two, two, std::vector{length}), std::invalid_argument);
  }
}

}  // namespace
}  // namespace vdbmap::registration
