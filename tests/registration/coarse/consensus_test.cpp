// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/coarse/consensus.h"

#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/pose_distance.h"
#include "tests/support/random_points.h"
#include "tests/support/threads.h"

namespace vdbmap::registration {
namespace {

SurfacePoints random_surface(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  SurfacePoints points;
  points.positions =
      test::random_points(count, Eigen::AlignedBox3d(Eigen::Vector3d(-40, -40, -5), Eigen::Vector3d(40, 40, 5)), seed);
  for (std::size_t i = 0; i < count; ++i) points.normals.push_back(test::random_direction(random));
  points.planarities.assign(count, 1.0);
  return points;
}

SurfacePoints moved(SurfacePoints points, const Eigen::Isometry3d& motion, double noise, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, noise);
  for (Eigen::Vector3d& position : points.positions) {
    position = motion * position + test::vector_of([&] { return normal(random); });
  }
  for (Eigen::Vector3d& direction : points.normals) direction = motion.linear() * direction;
  return points;
}

// Every point with its own partner in `share` of the cases, else with any.
std::vector<FeatureMatch> matches_with_outliers(std::uint32_t count, double share, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<FeatureMatch> matches;
  for (std::uint32_t i = 0; i < count; ++i) {
    const bool is_true = uniform(random) < share;
    const auto any = static_cast<std::uint32_t>(uniform(random) * count);
    matches.push_back({i, is_true ? i : any, 0.1f, false});
  }
  return matches;
}

class ConsensusOutliers : public testing::TestWithParam<double> {};

TEST_P(ConsensusOutliers, LeaveThePoseAsItIs) {
  std::mt19937 random(7);
  const SurfacePoints source = random_surface(800, 1);
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Eigen::Isometry3d truth = test::random_motion(80, 35.0 * seed, random);
    const SurfacePoints target = moved(source, truth, 0.2, seed);
    const auto hypotheses = find_consensus(source, target, matches_with_outliers(800, GetParam(), seed));
    ASSERT_FALSE(hypotheses.empty());
    const auto error = test::distance_between(hypotheses.front().target_from_source, truth);
    // 0.2 m on each of n points leave 0.2 / sqrt(n) of the place; half a metre is far inside the 2 m that count.
    EXPECT_LT(error.translation, 0.5);
    EXPECT_LT(error.rotation_deg, 1.5);
    EXPECT_GT(static_cast<double>(hypotheses.front().num_inliers), 0.7 * GetParam() * 800);
  }
}

INSTANTIATE_TEST_SUITE_P(Shares, ConsensusOutliers, testing::Values(1.0, 0.3, 0.1, 0.04));

TEST(Consensus, OfTwoPlacesIsTwoHypotheses) {
  const SurfacePoints source = random_surface(300, 1);
  Eigen::Isometry3d here = Eigen::Isometry3d::Identity(), there = Eigen::Isometry3d::Identity();
  there.translation() = Eigen::Vector3d(200, 0, 0);
  SurfacePoints target = moved(source, here, 0.1, 2);
  const SurfacePoints second = moved(source, there, 0.1, 3);
  target.positions.insert(target.positions.end(), second.positions.begin(), second.positions.end());
  target.normals.insert(target.normals.end(), second.normals.begin(), second.normals.end());
  std::vector<FeatureMatch> matches;
  for (std::uint32_t i = 0; i < 300; ++i) matches.push_back({i, i % 3 == 0 ? i + 300 : i, 0.1f, false});

  const auto hypotheses = find_consensus(source, target, matches);
  ASSERT_EQ(hypotheses.size(), 2u);
  EXPECT_LT(test::distance_between(hypotheses[0].target_from_source, here).translation, 0.2);
  EXPECT_LT(test::distance_between(hypotheses[1].target_from_source, there).translation, 0.2);
}

TEST(Consensus, LeavesOutPosesThatTiltTooFar) {
  const SurfacePoints source = random_surface(200, 1);
  Eigen::Isometry3d tilted = Eigen::Isometry3d::Identity();
  tilted.rotate(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()));
  ConsensusOptions options;
  const auto matches = matches_with_outliers(200, 1, 1);
  EXPECT_EQ(find_consensus(source, moved(source, tilted, 0, 1), matches, options).size(), 1u);
  options.max_tilt_deg = 20;
  EXPECT_TRUE(find_consensus(source, moved(source, tilted, 0, 1), matches, options).empty());
}

TEST(Consensus, OfMatchesAtRandomIsSmall) {
  const SurfacePoints source = random_surface(800, 1);
  const auto hypotheses = find_consensus(source, random_surface(800, 99), matches_with_outliers(800, 0, 5));
  // Within 2 m and 45 degrees of any of some 6400 m^2 x 10 m: a handful at most.
  for (const PoseHypothesis& hypothesis : hypotheses) EXPECT_LT(hypothesis.num_inliers, 12u);
}

TEST(Consensus, OfNothingIsNothing) {
  EXPECT_TRUE(find_consensus({}, {}, {}).empty());
  const SurfacePoints two = random_surface(2, 1);
  EXPECT_TRUE(find_consensus(two, two, matches_with_outliers(1, 1, 1)).empty());
}

TEST(Consensus, DoesNotDependOnTheNumberOfThreads) {
  const SurfacePoints source = random_surface(600, 1);
  std::mt19937 random(7);
  const SurfacePoints target = moved(source, test::random_motion(30, 60, random), 0.2, 2);
  const auto find = [&] { return find_consensus(source, target, matches_with_outliers(600, 0.2, 3)); };
  const auto one = test::on_threads(1, find);
  const auto four = test::on_threads(4, find);
  ASSERT_EQ(one.size(), four.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].target_from_source.matrix(), four[i].target_from_source.matrix());
    EXPECT_EQ(one[i].num_inliers, four[i].num_inliers);
  }
}

TEST(Consensus, RefusesOptionsOutOfRange) {
  const auto refused = [](auto change) {
    ConsensusOptions options;
    change(options);
    EXPECT_THROW(options.check(), std::invalid_argument);
  };
  refused([](ConsensusOptions& o) { o.inlier_distance = 0; });
  refused([](ConsensusOptions& o) { o.max_length_difference = std::numeric_limits<double>::quiet_NaN(); });
  refused([](ConsensusOptions& o) { o.max_matches = 0; });
  refused([](ConsensusOptions& o) { o.max_hypotheses = 0; });
  refused([](ConsensusOptions& o) { o.max_tilt_deg = 181; });
}

}  // namespace
}  // namespace vdbmap::registration
