// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/change/surface_comparison.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace vdbmap {
namespace {

const SignificanceLimits kLimits(0.01, 0.01, 0.001);

PointSums sums_of_points(const std::vector<Eigen::Vector3d>& points) {
  PointSums sums;
  for (const Eigen::Vector3d& p : points) {
    sums.add({{1, p.x(), p.y(), p.z(), p.x() * p.x(), p.y() * p.y(), p.z() * p.z(), p.x() * p.y(), p.x() * p.z(),
               p.y() * p.z()}});
  }
  return sums;
}

// Points on a plane through (0, 0, height), 30 cm wide, with noise along it.
LocalSurface plane_at(double height, double noise, std::size_t count, unsigned seed, double tilt = 0) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(-0.15, 0.15);
  std::normal_distribution<double> error(0, noise);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = share(random);
    points.emplace_back(x, share(random), height + tilt * x + error(random));
  }
  return surface_of(sums_of_points(points));
}

TEST(SignificanceLimits, AreTheQuantilesOfTables) {
  EXPECT_NEAR(kLimits.sigmas, 3.2905, 1e-3);
  EXPECT_NEAR(kLimits.radius * kLimits.radius, 16.266, 1e-3);  // chi squared, 3 degrees of freedom
  EXPECT_NEAR(SignificanceLimits(0, 0, 0.05).sigmas, 1.95996, 1e-4);
  EXPECT_NEAR(std::pow(SignificanceLimits(0, 0, 0.05).radius, 2), 7.815, 1e-3);
  EXPECT_NEAR(kLimits.common_variance, 2e-4, 1e-12);
}

TEST(DistanceBetween, OfPlanesIsThatAlongTheirNormal) {
  const LocalSurface low = plane_at(0, 0.005, 400, 1), high = plane_at(0.08, 0.005, 400, 2);
  const Distance distance = distance_between(high, high, low, 0.1, kLimits);
  EXPECT_TRUE(distance.is_between_planes);
  EXPECT_TRUE(distance.is_significant());
  EXPECT_NEAR(distance.sigmas, 0.08 / std::sqrt(2e-4), 0.3);
  EXPECT_FALSE(distance_between(low, low, plane_at(0.03, 0.005, 400, 3), 0.1, kLimits).is_significant());
}

TEST(DistanceBetween, AveragesNoiseOutButNotWhatSurveysHaveInCommon) {
  // Noise of 3 cm: of 400 points a mean has 1.5 mm.
  const LocalSurface low = plane_at(0, 0.03, 400, 4), high = plane_at(0.08, 0.03, 400, 5);
  EXPECT_TRUE(distance_between(high, high, low, 0.1, kLimits).is_significant());
  const SignificanceLimits unsure(0.03, 0.01, 0.001);
  EXPECT_FALSE(distance_between(high, high, low, 0.1, unsure).is_significant());
}

// What is drawn from one distribution is significant about as often as the level says, without common errors.
TEST(DistanceBetween, IsSignificantByChanceAsOftenAsTheLevelSays) {
  const SignificanceLimits limits(0, 0, 0.05);
  int count = 0;
  constexpr int kTrials = 2000;
  for (unsigned trial = 0; trial < kTrials; ++trial) {
    LocalSurface a = plane_at(0, 0.01, 60, 10'000 + trial), b = plane_at(0, 0.01, 60, 20'000 + trial);
    count += distance_between(a, a, b, 0.1, limits).is_significant() ? 1 : 0;
  }
  // Normals are estimated from the same points, and kSlope allows for them: fewer than the level, not more.
  EXPECT_LT(count, 0.07 * kTrials);
  EXPECT_GT(count, 0.005 * kTrials);
}

TEST(DistanceBetween, OfAVoxelFromAPlaneCountsThePlanesThickness) {
  const LocalSurface plane = plane_at(0, 0.03, 400, 6);
  LocalSurface point;
  point.count = 1;
  point.mean = {0, 0, 0.09};
  EXPECT_FALSE(distance_between(point, point, plane, 0.1, kLimits).is_significant());  // a point of noise
  point.mean.z() = 0.2;
  EXPECT_TRUE(distance_between(point, point, plane, 0.1, kLimits).is_significant());
}

TEST(DistanceOfEdges, IsHowFarTheEdgeMoved) {
  // One map fills its voxel, the other a share of the next one as well: the edge moved by that share.
  for (const double share : {0.1, 0.5, 1.0}) {
    const VoxelPoints full{{0.05, 0, 0}, 1e6}, next{{0.1 + 0.05 * share, 0, 0}, 1e6};
    EXPECT_NEAR(distance_of_edges(next, full, 0.1, kLimits).sigmas, 0.1 * share / std::sqrt(2e-4), 1e-3);
  }
  const VoxelPoints few{{0.05, 0, 0}, 1}, next_few{{0.15, 0, 0}, 1};
  EXPECT_FALSE(distance_of_edges(next_few, few, 0.1, kLimits).is_significant());
}

TEST(ConfidenceOf, IsAHalfAtTheLimit) {
  EXPECT_NEAR(confidence_of({3.29, 3.29}), 0.5, 1e-9);
  EXPECT_GT(confidence_of({6, 3.29}), 0.99);
}

}  // namespace
}  // namespace vdbmap
