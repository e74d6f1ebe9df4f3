// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/moments.h"

#include <gtest/gtest.h>

#include "tests/support/brute_force.h"
#include "tests/support/random_points.h"

namespace vdbmap {
namespace {

const Eigen::Vector3d kFarAway(550'000, 5'800'000, 50);  // [m]

Moments single(const Eigen::Vector3d& point) { return {.count = 1, .mean = point}; }

Moments merged_one_by_one(const std::vector<Eigen::Vector3d>& points) {
  Moments sum;
  for (const Eigen::Vector3d& point : points) sum = merge(sum, single(point));
  return sum;
}

std::vector<Eigen::Vector3d> points_around(const Eigen::Vector3d& center, std::size_t count, unsigned seed) {
  const Eigen::Vector3d half_edge(0.05, 0.02, 0.3);
  return test::random_points(count, {center - half_edge, center + half_edge}, seed);
}

TEST(Moments, OfNothingAndOfOnePointHaveNoCovariance) {
  EXPECT_EQ(Moments().covariance(), Eigen::Matrix3d::Zero());
  EXPECT_EQ(single({1, 2, 3}).covariance(), Eigen::Matrix3d::Zero());
}

TEST(Moments, OfTwoPointsAreTheirMiddleAndHalfTheSquareOfTheirDifference) {
  const Moments pair = merge(single({1, 2, 3}), single({3, 1, 7}));
  const Eigen::Vector3d difference(2, -1, 4);

  EXPECT_EQ(pair.count, 2);
  EXPECT_TRUE(pair.mean.isApprox(Eigen::Vector3d(2, 1.5, 5)));
  EXPECT_TRUE(pair.covariance().isApprox(difference * difference.transpose() / 2));
}

TEST(Moments, OfEvenlySpacedPointsHaveTheVarianceOfWholeNumbers) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 101; ++i) points.emplace_back(0.5 * i, 0, 0);
  const Moments moments = merged_one_by_one(points);
  EXPECT_NEAR(moments.mean.x(), 25, 1e-12);
  EXPECT_NEAR(moments.covariance()(0, 0), 0.25 * 101 * 102 / 12, 1e-9);  // n (n + 1) / 12, divisor n - 1
}

TEST(Moments, OfRepeatedPointsHaveNoScatter) {
  const Moments moments = merged_one_by_one(std::vector<Eigen::Vector3d>(50, kFarAway));
  EXPECT_EQ(moments.count, 50);
  EXPECT_EQ(moments.mean, kFarAway);
  EXPECT_EQ(moments.scatter, Eigen::Matrix3d::Zero());
}

TEST(Moments, MergedOneByOneAreThoseOfTwoPasses) {
  const std::vector<Eigen::Vector3d> points = points_around({3, -2, 1}, 1000, 1);
  const Moments merged = merged_one_by_one(points);
  const Moments direct = test::two_pass_moments(points);
  EXPECT_EQ(merged.count, direct.count);
  EXPECT_TRUE(merged.mean.isApprox(direct.mean, 1e-14));
  EXPECT_TRUE(merged.scatter.isApprox(direct.scatter, 1e-11));  // 1000 roundings of 3 m in offsets of 0.1 m
}

TEST(Moments, MergedInAnyTreeAreThoseOfTwoPasses) {
  const std::vector<Eigen::Vector3d> points = points_around({3, -2, 1}, 1000, 2);
  for (const std::size_t cut : {1UL, 7UL, 500UL, 999UL}) {
    const std::vector<Eigen::Vector3d> head(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(cut));
    const std::vector<Eigen::Vector3d> tail(points.begin() + static_cast<std::ptrdiff_t>(cut), points.end());
    const Moments merged = merge(test::two_pass_moments(head), test::two_pass_moments(tail));
    EXPECT_TRUE(merged.mean.isApprox(test::two_pass_moments(points).mean, 1e-14));
    EXPECT_TRUE(merged.scatter.isApprox(test::two_pass_moments(points).scatter, 1e-12));
  }
}

TEST(Moments, MergeKeepsPrecisionFarFromTheOrigin) {
  const std::vector<Eigen::Vector3d> points = points_around(kFarAway, 1000, 3);
  const Moments merged = merged_one_by_one(points);
  const Moments direct = test::two_pass_moments(points);
  // Doubles near 5.8e6 lie 9e-10 m apart, which the mean carries into offsets of 0.05 m; sums of squares would lose
  // all.
  EXPECT_LT((merged.mean - direct.mean).norm(), 1e-8);
  EXPECT_LT((merged.covariance() - direct.covariance()).norm(), 1e-9);
}

TEST(Moments, NothingIsTheNeutralElementOfMerge) {
  const Moments some = test::two_pass_moments(points_around(kFarAway, 10, 4));
  for (const Moments& merged : {merge(some, Moments()), merge(Moments(), some)}) {
    EXPECT_EQ(merged.count, some.count);
    EXPECT_EQ(merged.mean, some.mean);
    EXPECT_EQ(merged.scatter, some.scatter);
  }
  EXPECT_EQ(merge(Moments(), Moments()).count, 0);
}

}  // namespace
}  // namespace vdbmap
