// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/odometry/local_map.h"

#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/support/brute_force.h"
#include "tests/support/random_points.h"

namespace vdbmap::registration {
namespace {

const Eigen::AlignedBox3d kRoom(Eigen::Vector3d(-6, -5, -3), Eigen::Vector3d(5, 6, 4));

LocalMap map_of(const std::vector<Eigen::Vector3d>& points, const LocalMapOptions& options = {}) {
  LocalMap map(options);
  map.insert(points);
  return map;
}

// The nearest point in the 27 voxels around the query.
std::optional<Eigen::Vector3d> nearest_by_brute_force(const std::vector<Eigen::Vector3d>& points,
                                                      const Eigen::Vector3d& query, double voxel_size,
                                                      double max_distance) {
  std::optional<Eigen::Vector3d> nearest;
  double least = max_distance;
  const VoxelIndex center = voxel_of_point(query, 1 / voxel_size);
  for (const Eigen::Vector3d& point : points) {
    const VoxelIndex offset = voxel_of_point(point, 1 / voxel_size) - center;
    const bool is_beside = std::abs(offset.x()) <= 1 && std::abs(offset.y()) <= 1 && std::abs(offset.z()) <= 1;
    if (!is_beside || (point - query).norm() >= least) continue;
    least = (point - query).norm();
    nearest = point;
  }
  return nearest;
}

TEST(LocalMap, FindsTheNeighborThatBruteForceFinds) {
  for (const double voxel_size : {0.5, 1.0, 2.3}) {
    LocalMapOptions options;
    options.voxel_size = voxel_size;
    const LocalMap map = map_of(test::random_points(4000, kRoom, 1), options);
    const std::vector<Eigen::Vector3d> points = map.points();
    for (const double max_distance : {0.2, 0.6, 6.0}) {
      for (const Eigen::Vector3d& query : test::random_points(500, kRoom, 2)) {
        const auto found = map.nearest(query, max_distance);
        const auto expected = nearest_by_brute_force(points, query, voxel_size, max_distance);
        ASSERT_EQ(found.has_value(), expected.has_value());
        // Floats of some metres: two points whose distances differ by less may take each other's place.
        if (found) {
          EXPECT_NEAR((*found - query).norm(), (*expected - query).norm(), 1e-6);
        }
      }
    }
  }
}

TEST(LocalMap, KeepsPointsToMicrometresFarFromTheOrigin) {
  const Eigen::Vector3d far(900'000.3, -700'000.7, 41.2);
  std::vector<Eigen::Vector3d> points = test::random_points(500, kRoom, 1);
  for (Eigen::Vector3d& point : points) point += far;
  LocalMapOptions options;
  options.points_per_voxel = 24;
  const LocalMap map = map_of(points, options);
  for (const Eigen::Vector3d& kept : map.points()) {
    const auto nearest = nearest_by_brute_force(points, kept, 1, 0.1);
    ASSERT_TRUE(nearest);
    EXPECT_LT((*nearest - kept).norm(), 1e-6);
  }
}

TEST(LocalMap, HoldsABoundedNumberOfPointsInEachVoxelApartFromEachOther) {
  LocalMapOptions options;
  options.points_per_voxel = 5;
  const LocalMap map = map_of(test::random_points(50'000, kRoom, 1), options);
  const double spacing = 1 / std::sqrt(5.0);  // voxel size / sqrt(points a voxel)
  const std::vector<Eigen::Vector3d> points = map.points();
  for (const auto& [voxel, numbers] : test::points_by_voxel(points, 1)) {
    EXPECT_LE(numbers.size(), 5U);
    for (const std::size_t a : numbers) {
      for (const std::size_t b : numbers) {
        if (a != b) {
          EXPECT_GT((points[a] - points[b]).norm(), spacing - 1e-6);
        }
      }
    }
  }
  EXPECT_EQ(map.num_points(), points.size());
}

TEST(LocalMap, ThePointsThatComeFirstStay) {
  const std::vector<Eigen::Vector3d> points = {{0.1, 0.1, 0.1}, {0.12, 0.1, 0.1}, {0.9, 0.9, 0.9}};
  const LocalMap map = map_of(points);
  const std::vector<Eigen::Vector3d> kept = map.points();
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_LT((kept[0] - points[0]).norm(), 1e-7);
  EXPECT_LT((kept[1] - points[2]).norm(), 1e-7);
}

TEST(LocalMap, ForgetsExactlyTheVoxelsOutOfReach) {
  LocalMapOptions options;
  options.max_distance = 4;
  LocalMap map = map_of(test::random_points(4000, kRoom, 1), options);
  const std::vector<Eigen::Vector3d> before = map.points();
  const Eigen::Vector3d sensor(1.5, 2, 0);
  map.forget_far(sensor);

  std::vector<Eigen::Vector3d> expected;
  for (const Eigen::Vector3d& point : before) {
    if ((center_of_voxel(voxel_of_point(point, 1), 1) - sensor).norm() <= 4) expected.push_back(point);
  }
  ASSERT_LT(expected.size(), before.size());
  EXPECT_EQ(map.points(), expected);
  for (const Eigen::Vector3d& point : expected) EXPECT_EQ(map.nearest(point, 0.01), point);
  for (const Eigen::Vector3d& point : before) {
    EXPECT_EQ(map.nearest(point, 1e-5).has_value(),
              (center_of_voxel(voxel_of_point(point, 1), 1) - sensor).norm() <= 4);
  }
}

TEST(LocalMap, GrowsNoFurtherWhileTheSensorMoves) {
  LocalMapOptions options;
  options.max_distance = 5;
  LocalMap map(options);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d sensor(i, 0, 0);
    std::vector<Eigen::Vector3d> points = test::random_points(2000, kRoom, static_cast<unsigned>(i));
    for (Eigen::Vector3d& point : points) point += sensor;
    map.insert(points);
    map.forget_far(sensor);
    EXPECT_LE(map.num_voxels(), 11U * 11U * 11U);
  }
}

TEST(LocalMap, OfNothingFindsNothing) {
  const LocalMap map(LocalMapOptions{});
  EXPECT_TRUE(map.empty());
  EXPECT_EQ(map.nearest({0, 0, 0}, 10), std::nullopt);
}

TEST(LocalMap, LeavesOutWhatHasNoAddress) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const LocalMap map = map_of({{nan, 0, 0}, {0, 1e9, 0}, {1, 1, 1}});
  EXPECT_EQ(map.num_points(), 1U);
  EXPECT_EQ(map.nearest({nan, 0, 0}, 10), std::nullopt);
  EXPECT_EQ(map.nearest({0, 0, -1e9}, 10), std::nullopt);
}

TEST(LocalMap, RefusesBadOptions) {
  EXPECT_THROW(LocalMap({0, 20, 100}), std::invalid_argument);
  EXPECT_THROW(LocalMap({1, 0, 100}), std::invalid_argument);
  EXPECT_THROW(LocalMap({1, 25, 100}), std::invalid_argument);
  EXPECT_THROW(LocalMap({1, 20, std::numeric_limits<double>::quiet_NaN()}), std::invalid_argument);
}

}  // namespace
}  // namespace vdbmap::registration
