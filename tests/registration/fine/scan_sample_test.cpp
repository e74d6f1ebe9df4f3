// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/fine/scan_sample.h"

#include <array>
#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "tests/support/random_points.h"

namespace vdbmap::registration {
namespace {

constexpr RangeLimits kAll{0, 1000};

std::vector<Eigen::Vector3d> first_of_every_cube(const std::vector<Eigen::Vector3d>& points, double spacing) {
  std::set<std::array<double, 3>> cubes;
  std::vector<Eigen::Vector3d> first;
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Array3d cube = (point.array() / spacing).floor();
    if (cubes.insert({cube.x(), cube.y(), cube.z()}).second) first.push_back(point);
  }
  return first;
}

TEST(ScanSample, KeepsTheFirstPointOfEveryCubeInTheirOrder) {
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-20, -15, -3), Eigen::Vector3d(25, 20, 5));
  const std::vector<Eigen::Vector3d> points = test::random_points(50'000, box, 1);
  for (const double spacing : {0.1, 0.5, 1.0, 1.5, 40.0}) {
    EXPECT_EQ(sample_points(points, spacing, kAll), first_of_every_cube(points, spacing)) << spacing;
  }
}

TEST(ScanSample, IndicesLeadToTheSamePoints) {
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-20, -15, -3), Eigen::Vector3d(25, 20, 5));
  const std::vector<Eigen::Vector3d> points = test::random_points(50'000, box, 2);
  std::vector<Eigen::Vector3d> sample;
  for (const std::uint32_t index : sample_indices(points, 1.5, {2, 20})) sample.push_back(points[index]);
  EXPECT_EQ(sample, sample_points(points, 1.5, {2, 20}));
}

TEST(ScanSample, UsesPointsFromTheLeastToTheGreatestRange) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 20; ++i) points.emplace_back(0, -i, 0);
  const std::vector<Eigen::Vector3d> sample = sample_points(points, 0.5, {3, 7});
  EXPECT_EQ(sample, std::vector<Eigen::Vector3d>(points.begin() + 3, points.begin() + 8));
}

TEST(ScanSample, APointOutOfRangeTakesNoCube) {
  const std::vector<Eigen::Vector3d> points = {{0.5, 0.1, 0.1}, {0.99, 0.9, 0.9}};
  EXPECT_EQ(sample_points(points, 1, {1, 10}), std::vector<Eigen::Vector3d>{points[1]});
}

TEST(ScanSample, DropsPointsThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<Eigen::Vector3d> points = {
      {nan, 1, 1}, {1, -infinity, 1}, {2, 2, 2}, {2, 2, nan}, {infinity, nan, 0}};
  EXPECT_EQ(sample_points(points, 1, kAll), std::vector<Eigen::Vector3d>{points[2]});
}

TEST(ScanSample, OfNothingIsNothing) {
  EXPECT_TRUE(sample_points({}, 1, kAll).empty());
  const std::vector<Eigen::Vector3d> far = {{500, 0, 0}};
  EXPECT_TRUE(sample_points(far, 1, {1, 100}).empty());
}

TEST(ScanSample, CubesOfTheSameHashAreToldApart) {
  // As many cubes as points: the set of cubes is as full as it gets.
  std::vector<Eigen::Vector3d> points;
  for (int x = -30; x < 30; ++x) {
    for (int y = -30; y < 30; ++y) {
      for (int z = -5; z < 5; ++z) points.emplace_back(x + 0.5, y + 0.5, z + 0.5);
    }
  }
  EXPECT_EQ(sample_points(points, 1, kAll), points);
}

}  // namespace
}  // namespace vdbmap::registration
