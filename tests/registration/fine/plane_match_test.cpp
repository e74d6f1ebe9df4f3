// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/fine/plane_match.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/random_points.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/threads.h"
#include "vdbmap/core/eigen_features.h"
#include "vdbmap/core/map_builder.h"

namespace vdbmap::registration {
namespace {

const VoxelMap& room_map() {
  static const VoxelMap map = [] {
    BuildOptions options;
    options.anchor = Eigen::Vector3d::Zero();
    return build_map(test::sample_scene(test::room(), 60, 1), options);  // thin: empty voxels in between
  }();
  return map;
}

// Points near the surfaces, some off them, seen from a scanner in the room.
std::vector<Eigen::Vector3d> points_in_scan(const Eigen::Isometry3d& local_from_scan) {
  std::vector<Eigen::Vector3d> points =
      test::random_points(1500, {Eigen::Vector3d(-6.5, -4.5, -0.5), Eigen::Vector3d(6.5, 4.5, 3.5)}, 2);
  const std::vector<Eigen::Vector3d> on_floor =
      test::random_points(500, {Eigen::Vector3d(-6, -4, -0.1), Eigen::Vector3d(6, 4, 0.1)}, 3);
  points.insert(points.end(), on_floor.begin(), on_floor.end());
  for (Eigen::Vector3d& point : points) point = local_from_scan.inverse() * point;
  return points;
}

Eigen::Isometry3d scanner_pose() {
  std::mt19937 random(4);
  return test::random_motion(1.5, 40, random);
}

// How far the points searched that belong to the surface lie above its nearest mean, on average: those within half a
// voxel along the normal and 14 degrees (cosine 0.97) of it.
double height_of_surface(const PlaneMatch& match, const VoxelLevel& level, const VoxelIndex& center,
                         const MatchOptions& options) {
  double sum = 0;
  double count = 0;
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
    const VoxelIndex step = voxel - center;
    if (std::max({std::abs(step.x()), std::abs(step.y()), std::abs(step.z())}) > options.search_voxels) return;
    const VoxelRecord& record = level.records()[number];
    const double height = match.normal.dot(mean_of(record, voxel, level.voxel_size()) - match.mean);
    const bool is_same =
        std::abs(height) <= 0.5 * level.voxel_size() && std::abs(normal_of(record).dot(match.normal)) >= 0.97;
    if (!is_same) return;
    sum += record.count * height;
    count += record.count;
  });
  return sum / count;
}

// The match of one point, by looking at every voxel of the level.
std::optional<PlaneMatch> brute_force_match(const Eigen::Vector3d& point_in_scan, const VoxelLevel& level,
                                            const Eigen::Isometry3d& local_from_scan, const MatchOptions& options) {
  const Eigen::Vector3d point = local_from_scan * point_in_scan;
  const VoxelIndex center = voxel_of_point(point, voxels_per_metre(level.voxel_size()));
  const VoxelRecord* nearest = nullptr;
  PlaneMatch match{point_in_scan, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), 0};
  double nearest_distance = std::numeric_limits<double>::infinity();
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
    const VoxelIndex step = voxel - center;
    if (std::max({std::abs(step.x()), std::abs(step.y()), std::abs(step.z())}) > options.search_voxels) return;
    const Eigen::Vector3d mean = mean_of(level.records()[number], voxel, level.voxel_size());
    if ((mean - point).norm() >= nearest_distance) return;
    nearest_distance = (mean - point).norm();
    nearest = &level.records()[number];
    match.mean = mean;
  });
  if (!nearest || (options.plane_from_voxel && nearest->count < 5)) return std::nullopt;  // 5 points make a plane
  const PlaneFit own = fit_plane(covariance_of(*nearest));
  match.normal = options.plane_from_voxel ? own.normal : normal_of(*nearest);
  match.planarity = options.plane_from_voxel ? own.planarity : planarity_of(*nearest);
  if (!options.plane_from_voxel) match.mean += height_of_surface(match, level, center, options) * match.normal;
  if (match.planarity < options.min_planarity || match.planarity <= 0) return std::nullopt;
  return match;
}

struct Search {
  bool on_coarse_level;
  MatchOptions options;
};

class PlaneMatchSearch : public testing::TestWithParam<Search> {};

TEST_P(PlaneMatchSearch, FindsThePlaneOfTheNearestMean) {
  const auto [on_coarse_level, options] = GetParam();
  const VoxelLevel& level = on_coarse_level ? room_map().coarsest() : room_map().finest();
  std::vector<Eigen::Vector3d> points = points_in_scan(scanner_pose());
  if (!on_coarse_level) points.erase(points.begin(), points.begin() + 1300);  // brute force over 30,000 voxels is slow
  std::vector<PlaneMatch> expected;
  for (const Eigen::Vector3d& point : points) {
    const auto match = brute_force_match(point, level, scanner_pose(), options);
    if (match) expected.push_back(*match);
  }

  const std::vector<PlaneMatch> found = match_planes(points, level, scanner_pose(), options);
  ASSERT_GT(expected.size(), 50U);
  ASSERT_LT(expected.size(), points.size());
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].point, expected[i].point);
    EXPECT_TRUE(found[i].mean.isApprox(expected[i].mean, 1e-12));
    EXPECT_TRUE(found[i].normal.isApprox(expected[i].normal, 1e-12));
    EXPECT_DOUBLE_EQ(found[i].planarity, expected[i].planarity);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Searches, PlaneMatchSearch,
    testing::Values(Search{false, {.search_voxels = 1}}, Search{false, {.search_voxels = 3, .min_planarity = 0.6}},
                    Search{false, {.search_voxels = 0, .min_planarity = 0}},
                    Search{true, {.search_voxels = 1, .min_planarity = 0.3, .plane_from_voxel = true}},
                    Search{true, {.search_voxels = 2, .min_planarity = 0.5, .plane_from_voxel = true}}));

TEST(PlaneMatch, ANoisySurfaceBetweenTwoLayersOfVoxelsIsOnePlane) {
  // A floor on the border of two layers with 2 cm of noise: means of 1.6 cm above and below it.
  PointCloud floor = test::sample_scene({{{-3, -3, 0}, {6, 0, 0}, {0, 6, 0}}}, 2000, 5);
  std::mt19937 random(6);
  std::normal_distribution<double> noise(0, 0.02);
  for (Eigen::Vector3d& point : floor.positions) point.z() += noise(random);
  BuildOptions options;
  options.anchor = Eigen::Vector3d::Zero();
  const VoxelMap map = build_map(floor, options);
  const std::vector<Eigen::Vector3d> points =
      test::random_points(200, {Eigen::Vector3d(-2, -2, -0.02), Eigen::Vector3d(2, 2, 0.02)}, 7);
  double sum = 0;
  for (const PlaneMatch& match : match_planes(points, map.finest(), Eigen::Isometry3d::Identity(), {})) {
    sum += match.mean.z();
    EXPECT_LT(std::abs(match.mean.z()), 0.006);  // 2 cm over 180 points and more
  }
  EXPECT_LT(std::abs(sum / 200), 0.001);
}

TEST(PlaneMatch, PlanesAreUnitAndLieInTheRoom) {
  const auto matches = match_planes(points_in_scan(scanner_pose()), room_map().finest(), scanner_pose(), {});
  ASSERT_GT(matches.size(), 100U);
  for (const PlaneMatch& match : matches) {
    EXPECT_NEAR(match.normal.norm(), 1, 1e-6);
    EXPECT_LE((scanner_pose() * match.point - match.mean).cwiseAbs().maxCoeff(), 0.2);  // two voxels on an axis
  }
}

TEST(PlaneMatch, PointsFarFromTheMapHaveNoPlane) {
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<Eigen::Vector3d> points = {{500, 0, 0}, {2e6, 0, 0}, {0, -1e300, 0}, {0, 0, infinity}};
  EXPECT_TRUE(match_planes(points, room_map().finest(), Eigen::Isometry3d::Identity(), {}).empty());
  EXPECT_TRUE(match_planes({}, room_map().finest(), Eigen::Isometry3d::Identity(), {}).empty());
}

TEST(PlaneMatch, DoesNotDependOnTheNumberOfThreads) {
  const std::vector<Eigen::Vector3d> points = points_in_scan(scanner_pose());
  const auto match = [&] { return match_planes(points, room_map().finest(), scanner_pose(), {}); };
  const std::vector<PlaneMatch> on_one = test::on_threads(1, match);
  const std::vector<PlaneMatch> on_four = test::on_threads(4, match);
  ASSERT_EQ(on_four.size(), on_one.size());
  for (std::size_t i = 0; i < on_one.size(); ++i) {
    EXPECT_EQ(on_four[i].point, on_one[i].point);
    EXPECT_EQ(on_four[i].mean, on_one[i].mean);
    EXPECT_EQ(on_four[i].normal, on_one[i].normal);
  }
}

}  // namespace
}  // namespace vdbmap::registration
