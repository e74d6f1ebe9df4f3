// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/coarse/fpfh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/random_points.h"
#include "tests/support/sample_maps.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/threads.h"
#include "vdbmap/core/map_builder.h"

namespace vdbmap::registration {
namespace {

TEST(PairAngles, OfTwoPointsOfOnePlaneAreZero) {
  const PairAngles angles = pair_angles({0, 0, 0}, {0, 0, 1}, {3, 4, 0}, {0, 0, 1});
  EXPECT_NEAR(angles.alpha, 0, 1e-12);
  EXPECT_NEAR(angles.phi, 0, 1e-12);
  EXPECT_NEAR(angles.theta, 0, 1e-12);
}

TEST(PairAngles, OfFloorAndWallAreThoseOfTheDefinition) {
  // The source is the wall, whose normal u = (-1, 0, 0) makes the smaller angle with the line (-2, 0, -1) to the floor:
  // v = line x u points along +y, w = u x v along -z, and the floor's normal is -w.
  const PairAngles angles = pair_angles({0, 0, 0}, {0, 0, 1}, {2, 0, 1}, {-1, 0, 0});
  EXPECT_NEAR(angles.alpha, 0, 1e-12);
  EXPECT_NEAR(angles.phi, 2 / std::sqrt(5), 1e-12);
  EXPECT_NEAR(angles.theta, -std::numbers::pi / 2, 1e-12);
}

TEST(PairAngles, OfASlantedPairAreThoseByHand) {
  // u = (0, 0, 1), the line (1, 0, 1) / sqrt(2): v = (0, -1, 0), w = (1, 0, 0).
  const PairAngles angles = pair_angles({0, 0, 0}, {0, 0, 1}, {3, 0, 3}, {0.48, 0.64, -0.6});
  EXPECT_NEAR(angles.alpha, -0.64, 1e-12);
  EXPECT_NEAR(angles.phi, 1 / std::sqrt(2), 1e-12);
  EXPECT_NEAR(angles.theta, std::atan2(0.48, -0.6), 1e-12);
}

TEST(PairAngles, DoNotDependOnTheOrderNorOnTheFrame) {
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d a = 5 * test::random_direction(random), b = 5 * test::random_direction(random);
    const Eigen::Vector3d normal_a = test::random_direction(random), normal_b = test::random_direction(random);
    const Eigen::Isometry3d motion = test::random_motion(50, 123, random);
    const PairAngles angles = pair_angles(a, normal_a, b, normal_b);
    for (const PairAngles& same :
         {pair_angles(b, normal_b, a, normal_a),
          pair_angles(motion * a, motion.linear() * normal_a, motion * b, motion.linear() * normal_b)}) {
      EXPECT_NEAR(same.alpha, angles.alpha, 1e-9);
      EXPECT_NEAR(same.phi, angles.phi, 1e-9);
      EXPECT_NEAR(std::remainder(same.theta - angles.theta, 2 * std::numbers::pi), 0, 1e-9);
    }
  }
}

TEST(PairAngles, AlongTheNormalAreFinite) {
  const PairAngles angles = pair_angles({0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {1, 0, 0});
  EXPECT_DOUBLE_EQ(angles.phi, 1);
  EXPECT_TRUE(std::isfinite(angles.theta));
}

using Histogram = std::vector<double>;

// Equation 3 of the paper over all pairs of points by their distances, with no grid.
Histogram simple_histogram(const SurfacePoints& points, std::size_t i, double radius) {
  Histogram histogram(kFpfhBins, 0.0);
  double count = 0;
  const auto bin = [](double share) {
    return std::clamp(static_cast<int>(share * kBinsPerAngle), 0, kBinsPerAngle - 1);
  };
  for (std::size_t j = 0; j < points.size(); ++j) {
    if (j == i || (points.positions[j] - points.positions[i]).norm() > radius) continue;
    const PairAngles angles =
        pair_angles(points.positions[i], points.normals[i], points.positions[j], points.normals[j]);
    ++histogram[static_cast<std::size_t>(bin((angles.alpha + 1) / 2))];
    ++histogram[static_cast<std::size_t>(kBinsPerAngle + bin((angles.phi + 1) / 2))];
    ++histogram[static_cast<std::size_t>(2 * kBinsPerAngle + bin(angles.theta / (2 * std::numbers::pi) + 0.5))];
    ++count;
  }
  for (double& value : histogram) value /= std::max(count, 1.0);
  return histogram;
}

// Equation 4: its own histogram and those of the neighbours by the inverse of their distance.
Histogram brute_force_feature(const SurfacePoints& points, std::size_t i, double radius) {
  Histogram sum(kFpfhBins, 0.0);
  double count = 0;
  for (std::size_t j = 0; j < points.size(); ++j) {
    const double distance = (points.positions[j] - points.positions[i]).norm();
    if (j == i || distance > radius) continue;
    const Histogram neighbor = simple_histogram(points, j, radius);
    for (std::size_t b = 0; b < sum.size(); ++b) sum[b] += neighbor[b] / distance;
    ++count;
  }
  Histogram feature = simple_histogram(points, i, radius);
  for (std::size_t b = 0; b < sum.size(); ++b) feature[b] += sum[b] / std::max(count, 1.0);
  for (std::size_t first = 0; first < feature.size(); first += kBinsPerAngle) {
    double total = 0;
    for (std::size_t b = first; b < first + kBinsPerAngle; ++b) total += feature[b];
    for (std::size_t b = first; b < first + kBinsPerAngle; ++b) feature[b] /= std::max(total, 1e-12);
  }
  return feature;
}

TEST(Fpfh, AgreesWithBruteForce) {
  const VoxelLevel level = test::coarse_level(test::sample_scene(test::room(), 40, 3));
  const SurfacePoints points = surface_points(level, 5);
  const FpfhMatrix features = fpfh_features(level, points, 3.5);
  ASSERT_EQ(features.cols(), static_cast<Eigen::Index>(level.size()));
  for (std::size_t i = 0; i < points.size(); i += 13) {
    const Histogram expected = brute_force_feature(points, i, 3.5);
    for (int b = 0; b < kFpfhBins; ++b) {
      // Floats, and angles on the edge between two bins.
      EXPECT_NEAR(features(b, static_cast<Eigen::Index>(i)), expected[static_cast<std::size_t>(b)], 2e-5);
    }
  }
}

TEST(Fpfh, OfALonelyVoxelIsZero) {
  PointCloud cloud;
  cloud.positions = {{0.5, 0.5, 0.5}, {50.5, 0.5, 0.5}};
  const VoxelLevel level = test::coarse_level(cloud);
  EXPECT_TRUE(fpfh_features(level, surface_points(level, 5), 5).isZero());
}

TEST(Fpfh, DoesNotDependOnTheNumberOfThreads) {
  const VoxelLevel level = test::coarse_level(test::sample_scene(test::street(), 20, 3));
  const auto features = [&] { return fpfh_features(level, surface_points(level, 7), 5); };
  EXPECT_EQ(test::on_threads(1, features), test::on_threads(4, features));
}

}  // namespace
}  // namespace vdbmap::registration
