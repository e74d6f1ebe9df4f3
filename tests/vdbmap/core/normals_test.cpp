// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/normals.h"

#include <cmath>
#include <random>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "tests/support/brute_force.h"
#include "tests/support/random_points.h"
#include "tests/support/synthetic_scene.h"
#include "vdbmap/core/map_builder.h"

namespace vdbmap {
namespace {

constexpr double kCodeAngle = 0.7 / 57.3;  // [rad] what the code of a normal may be off

VoxelMap map_of(const PointCloud& cloud, const std::vector<double>& voxel_sizes = {0.1}) {
  BuildOptions options;
  options.voxel_sizes = voxel_sizes;
  options.anchor = Eigen::Vector3d::Zero();
  return build_map(cloud, options);
}

double angle_between_lines(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

std::vector<std::size_t> indices_around(const test::PointsByVoxel& voxels, const VoxelIndex& center) {
  std::vector<std::size_t> numbers;
  for (std::int32_t x = -1; x <= 1; ++x) {
    for (std::int32_t y = -1; y <= 1; ++y) {
      for (std::int32_t z = -1; z <= 1; ++z) {
        const auto found = voxels.find(center.offsetBy(x, y, z));
        if (found != voxels.end()) numbers.insert(numbers.end(), found->second.begin(), found->second.end());
      }
    }
  }
  return numbers;
}

// Every normal against the eigenvectors of all points in the 27 voxels.
void expect_normals_of_brute_force(const VoxelLevel& level, const PointCloud& cloud) {
  const test::PointsByVoxel voxels = test::points_by_voxel(cloud.positions, level.voxel_size());
  std::size_t num_compared = 0;
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
    const VoxelRecord& record = level.records()[number];
    const std::vector<std::size_t> numbers = indices_around(voxels, voxel);
    if (numbers.size() < 3) {
      EXPECT_EQ(record.planarity_code, 0);
      return;
    }
    const Eigen::Matrix3d covariance = test::two_pass_moments(cloud.positions, numbers).covariance();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
    const Eigen::Vector3d values = solver.eigenvalues();
    const double planarity = (values[1] - values[0]) / values[2];
    EXPECT_NEAR(planarity_of(record), planarity, 0.5 / 255 + 1e-3);  // half a code; means to 4 um in 0.1 m
    EXPECT_GE(normal_of(record).z(), 0);
    if (planarity < 0.1) return;  // no direction to compare
    ++num_compared;
    EXPECT_LT(angle_between_lines(normal_of(record), solver.eigenvectors().col(0)), kCodeAngle + 1e-3) << voxel;
  });
  EXPECT_GT(num_compared, level.size() / 4);
}

TEST(Normals, AreThoseOfAllPointsInTwentySevenVoxels) {
  // Thin enough for gaps, over many leaves, on both sides of every axis.
  PointCloud cloud;
  cloud.positions = test::random_points(12'000, {Eigen::Vector3d(-2.3, -1.9, -0.4), Eigen::Vector3d(1.7, 2.1, 0.5)}, 1);
  expect_normals_of_brute_force(map_of(cloud).finest(), cloud);
}

TEST(Normals, AreThoseOfAllPointsAcrossRootNodesToo) {
  PointCloud cloud;
  const Eigen::Vector3d corner(409.6, -409.6, 0);  // where eight of OpenVDB's largest nodes meet, at 4096 voxels
  const Eigen::Vector3d half_edge = Eigen::Vector3d::Constant(0.6);
  cloud.positions = test::random_points(3000, {corner - half_edge, corner + half_edge}, 2);
  expect_normals_of_brute_force(map_of(cloud).finest(), cloud);
}

TEST(Normals, OfTheCoarserLevelAreThoseOfAllPointsToo) {
  const PointCloud cloud = test::sample_scene(test::room(), 20, 3);
  expect_normals_of_brute_force(map_of(cloud, {0.1, 1}).coarsest(), cloud);
}

class NormalsOfPlanes : public testing::TestWithParam<Eigen::Vector3d> {};

TEST_P(NormalsOfPlanes, AreTheNormalOfThePlane) {
  const Eigen::Vector3d normal = GetParam().normalized();
  const Eigen::Vector3d along = normal.unitOrthogonal();
  const Eigen::Vector3d corner = Eigen::Vector3d(0.013, 0.027, 0.031) - along - normal.cross(along);
  const PointCloud cloud = test::sample_scene({{corner, 2 * along, 2 * normal.cross(along)}}, 4000, 4);
  const VoxelMap map = map_of(cloud);
  ASSERT_GT(map.finest().size(), 400U);
  for (const VoxelRecord& record : map.finest().records()) {
    EXPECT_LT(angle_between_lines(normal_of(record), normal), kCodeAngle);
    EXPECT_GE(normal_of(record).z(), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Tilts, NormalsOfPlanes,
                         testing::Values(Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0),
                                         Eigen::Vector3d(0.1, 0, 1), Eigen::Vector3d(-1, 1, 0),
                                         Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(-0.3, 0.9, 0.02),
                                         Eigen::Vector3d(0.5, -0.4, 0.8), Eigen::Vector3d(-2, -3, 0.5)));

TEST(Normals, VoxelsWithoutNeighboursHaveNoPlane) {
  // One point every 0.5 m: no neighbourhood holds a second one.
  PointCloud cloud;
  for (int i = -20; i < 20; ++i) cloud.positions.emplace_back(0.5 * i + 0.03, 0.05, -0.5 * i + 0.07);
  const VoxelMap map = map_of(cloud);
  ASSERT_EQ(map.finest().size(), 40U);
  for (const VoxelRecord& record : map.finest().records()) {
    EXPECT_EQ(record.planarity_code, 0);
    EXPECT_TRUE(normal_of(record).isApprox(Eigen::Vector3d::UnitZ(), 1e-6));
  }
}

TEST(Normals, ThreePointsMakeAPlaneAndTwoDoNot) {
  const auto planarity_of_first = [](const std::vector<Eigen::Vector3d>& positions) {
    PointCloud cloud;
    cloud.positions = positions;
    return map_of(cloud).finest().records()[0].planarity_code;
  };
  EXPECT_EQ(planarity_of_first({{0.05, 0.05, 0.05}, {0.15, 0.05, 0.05}}), 0);
  EXPECT_GT(planarity_of_first({{0.05, 0.05, 0.05}, {0.15, 0.05, 0.05}, {0.05, 0.15, 0.05}}), 80);  // 1/3 of 255
}

}  // namespace
}  // namespace vdbmap
