// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/coarse/feature_matches.h"

#include <algorithm>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/threads.h"

namespace vdbmap::registration {
namespace {

FpfhMatrix random_features(Eigen::Index count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> share(0, 1);
  return FpfhMatrix::NullaryExpr(kFpfhBins, count, [&] { return share(random); });
}

std::vector<std::uint32_t> every_second(std::uint32_t count) {
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t i = 0; i < count; i += 2) numbers.push_back(i);
  return numbers;
}

std::uint32_t nearest(const Eigen::VectorXf& feature, const FpfhMatrix& features,
                      const std::vector<std::uint32_t>& chosen) {
  return *std::min_element(chosen.begin(), chosen.end(), [&](std::uint32_t a, std::uint32_t b) {
    return (features.col(a) - feature).norm() < (features.col(b) - feature).norm();
  });
}

TEST(FeatureMatches, AgreeWithBruteForce) {
  const FpfhMatrix source = random_features(300, 1);
  const FpfhMatrix target = random_features(2600, 2);  // more than one stripe
  const auto chosen_source = every_second(300);
  const auto chosen_target = every_second(2600);
  const auto matches = match_features(source, chosen_source, target, chosen_target, 1);
  ASSERT_EQ(matches.size(), chosen_source.size());
  for (const FeatureMatch& match : matches) {
    EXPECT_EQ(match.target, nearest(source.col(match.source), target, chosen_target));
    EXPECT_NEAR(match.distance, (source.col(match.source) - target.col(match.target)).norm(), 1e-3);
    EXPECT_EQ(match.mutual, nearest(target.col(match.target), source, chosen_source) == match.source);
  }
}

TEST(FeatureMatches, ComeMutualFirstAndThenByDistance) {
  const FpfhMatrix source = random_features(200, 3);
  const FpfhMatrix target = random_features(200, 4);
  const auto all = every_second(200);
  const auto matches = match_features(source, all, target, all, 3);
  EXPECT_EQ(matches.size(), 3 * all.size());
  EXPECT_TRUE(std::is_sorted(matches.begin(), matches.end(), [](const FeatureMatch& a, const FeatureMatch& b) {
    return a.mutual != b.mutual ? a.mutual : a.distance < b.distance;
  }));
  EXPECT_TRUE(matches.front().mutual);
}

TEST(FeatureMatches, OfNothingAreNone) {
  EXPECT_TRUE(match_features(random_features(3, 1), {0, 1, 2}, random_features(0, 2), {}, 3).empty());
  EXPECT_TRUE(match_features(random_features(0, 1), {}, random_features(3, 2), {0, 1, 2}, 3).empty());
}

TEST(FeatureMatches, DoNotDependOnTheNumberOfThreads) {
  const FpfhMatrix source = random_features(500, 5);
  const FpfhMatrix target = random_features(3000, 6);
  const auto match = [&] { return match_features(source, every_second(500), target, every_second(3000), 3); };
  const auto one = test::on_threads(1, match);
  const auto four = test::on_threads(4, match);
  ASSERT_EQ(one.size(), four.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].source, four[i].source);
    EXPECT_EQ(one[i].target, four[i].target);
    EXPECT_EQ(one[i].distance, four[i].distance);
  }
}

}  // namespace
}  // namespace vdbmap::registration
