// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/fine/shuffle.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "registration/fine/scan_sample.h"
#include "tests/support/random_points.h"
#include "tests/support/synthetic_scene.h"

namespace vdbmap::registration {
namespace {

bool comes_before(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

TEST(Shuffle, KeepsEveryPointOnce) {
  std::vector<Eigen::Vector3d> points =
      test::random_points(10'000, {Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 1, 1)}, 1);
  std::vector<Eigen::Vector3d> order = shuffled(points);
  EXPECT_NE(order, points);
  EXPECT_EQ(order, shuffled(points));
  std::ranges::sort(points, comes_before);
  std::ranges::sort(order, comes_before);
  EXPECT_EQ(order, points);
}

TEST(Shuffle, OfOnePointOrNoneIsTheSame) {
  EXPECT_TRUE(shuffled({}).empty());
  const std::vector<Eigen::Vector3d> one = {{1, 2, 3}};
  EXPECT_EQ(shuffled(one), one);
}

// Mean height over the floor of one point a cube.
double mean_height(const std::vector<Eigen::Vector3d>& points_in_scan, double sensor_height) {
  const std::vector<Eigen::Vector3d> sample = sample_points(points_in_scan, 1.0, {1, 20});
  double sum = 0;
  for (const Eigen::Vector3d& point : sample) sum += point.z() + sensor_height;
  return sum / static_cast<double>(sample.size());
}

TEST(Shuffle, TakesTheBiasOutOfTheFirstPointsOfCubes) {
  const double height = 1.5;  // [m]
  const test::Scene floor = {{{-25, -25, 0}, {50, 0, 0}, {0, 50, 0}}};
  double in_order = 0;
  double in_shuffled_order = 0;
  constexpr int kSeeds = 10;
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    const PointCloud scan = test::scan_scene(floor, Eigen::Isometry3d(Eigen::Translation3d(0, 0, height)),
                                             {.num_azimuths = 450, .range_noise = 0.03, .seed = seed});
    in_order += mean_height(scan.positions, height) / kSeeds;
    in_shuffled_order += mean_height(shuffled(scan.positions), height) / kSeeds;
  }
  // Some 8000 points in all, each 3 mm up or down: 0.04 mm. A mean below is what would push the scan up.
  EXPECT_LT(in_order, -3e-4);
  EXPECT_LT(std::abs(in_shuffled_order), 1.5e-4);
}

}  // namespace
}  // namespace vdbmap::registration
