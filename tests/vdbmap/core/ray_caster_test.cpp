// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/ray_caster.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/random_points.h"
#include "tests/support/sample_maps.h"
#include "tests/support/sanitizers.h"
#include "vdbmap/core/map_builder.h"

namespace vdbmap {
namespace {

constexpr double kEdge = 0.1;  // [m]

// Where a ray enters a voxel, by three pairs of planes; infinity where it misses or begins inside.
struct BoxEntry {
  double distance = std::numeric_limits<double>::infinity();
  VoxelFace face = 0;
};

BoxEntry enter(const Ray& ray, const VoxelIndex& voxel) {
  const Eigen::Vector3d corner = corner_of_voxel(voxel, kEdge);
  double begin = -std::numeric_limits<double>::infinity();
  double end = std::numeric_limits<double>::infinity();
  BoxEntry entry;
  for (int axis = 0; axis < 3; ++axis) {
    if (ray.direction[axis] == 0) {
      if (ray.origin[axis] < corner[axis] || ray.origin[axis] >= corner[axis] + kEdge) return {};
      continue;
    }
    const double a = (corner[axis] - ray.origin[axis]) / ray.direction[axis];
    const double b = (corner[axis] + kEdge - ray.origin[axis]) / ray.direction[axis];
    if (std::min(a, b) > begin) {
      begin = std::min(a, b);
      entry.face = static_cast<VoxelFace>(2 * axis + (ray.direction[axis] > 0 ? 0 : 1));
    }
    end = std::min(end, std::max(a, b));
  }
  if (begin < end && begin > 0) entry.distance = begin;
  return entry;
}

void expect_same_as_brute_force(const std::vector<VoxelIndex>& voxels, double reach, std::size_t num_rays,
                                unsigned seed) {
  const VoxelMap map = test::map_of_voxels(voxels);
  const RayCaster caster(map.finest());
  std::mt19937 random(seed);
  const auto origins =
      test::random_points(num_rays, {Eigen::Vector3d::Constant(-reach), Eigen::Vector3d::Constant(reach)}, seed);
  std::size_t num_hits = 0;
  for (const Eigen::Vector3d& origin : origins) {
    const Ray ray{origin, test::random_direction(random)};
    BoxEntry nearest;
    for (const VoxelIndex& voxel : voxels) {
      const BoxEntry entry = enter(ray, voxel);
      if (entry.distance < nearest.distance) nearest = entry;
    }
    const auto hit = caster.first_hit(ray);
    ASSERT_EQ(hit.has_value(), std::isfinite(nearest.distance));
    EXPECT_EQ(caster.is_blocked(ray, {}), hit.has_value());
    if (!hit) continue;
    ++num_hits;
    EXPECT_NEAR(hit->distance, nearest.distance, 1e-9);
    EXPECT_EQ(hit->face, nearest.face);
    EXPECT_FALSE(caster.is_blocked(ray, {0, hit->distance * (1 - 1e-9)}));
    EXPECT_TRUE(caster.is_blocked(ray, {0, hit->distance * (1 + 1e-9)}));
  }
  EXPECT_GT(num_hits, num_rays / 20);
}

TEST(RayCaster, AgreesWithRaysAgainstEveryBoxWhereVoxelsAreDense) {
  expect_same_as_brute_force(test::random_voxels(3000, -20, 20, 1), 3, test::kIsSanitized ? 200 : 2000, 2);
}

TEST(RayCaster, AgreesWithRaysAgainstEveryBoxAcrossAllLevelsOfTheTree) {
  // Slabs of voxels on both sides of the borders of the root's cells, 410 m from the middle.
  std::vector<VoxelIndex> voxels = test::random_voxels(500, -40, 40, 3);
  for (const std::int32_t far : {-4096 - 3, 4096 + 2, 4095}) {
    for (std::int32_t y = -30; y < 30; ++y) {
      for (std::int32_t z = -30; z < 30; ++z) voxels.emplace_back(far, 40 * y, 40 * z);
    }
  }
  const std::vector<VoxelIndex> pillars = voxels;
  for (const VoxelIndex& voxel : pillars) {
    for (int i = 1; i < 5; ++i) voxels.push_back(voxel.offsetBy(0, i, 2 * i));
  }
  std::sort(voxels.begin(), voxels.end());
  voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
  expect_same_as_brute_force(voxels, 6, test::kIsSanitized ? 50 : 300, 4);
}

TEST(RayCaster, RaysAlongTheAxesEnterTheFacingSide) {
  const VoxelMap map = test::map_of_voxels({{0, 0, 0}});
  const RayCaster caster(map.finest());
  const Eigen::Vector3d middle(0.05, 0.05, 0.05);
  for (VoxelFace face = 0; face < 6; ++face) {
    const Eigen::Vector3d normal = normal_of_face(face);
    const auto hit = caster.first_hit({middle + 7 * normal, -normal});
    ASSERT_TRUE(hit.has_value());
    EXPECT_EQ(hit->face, face);
    EXPECT_NEAR(hit->distance, 6.95, 1e-12);
    EXPECT_EQ(hit->voxel, VoxelIndex(0, 0, 0));
    EXPECT_EQ(hit->record, 0U);
    EXPECT_FALSE(caster.first_hit({middle + 7 * normal, normal}).has_value());
  }
}

TEST(RayCaster, RaysAlongTheBorderOfVoxelsBelongToTheUpperOne) {
  const VoxelMap map = test::map_of_voxels({{0, 0, 0}, {0, 8, 0}});
  const RayCaster caster(map.finest());
  // y = 0 is the lower face of voxel 0: it holds it; y = 0.1 belongs to the empty voxel 1.
  EXPECT_TRUE(caster.first_hit({{-1, 0, 0.05}, {1, 0, 0}}).has_value());
  EXPECT_FALSE(caster.first_hit({{-1, 0.1, 0.05}, {1, 0, 0}}).has_value());
}

TEST(RayCaster, TheVoxelInWhichARayBeginsIsNotInItsWay) {
  const VoxelMap map = test::map_of_voxels({{0, 0, 0}, {1, 0, 0}, {5, 0, 0}});
  const RayCaster caster(map.finest());
  const Ray ray{{0.05, 0.05, 0.05}, {1, 0, 0}};
  EXPECT_NEAR(caster.first_hit(ray)->distance, 0.05, 1e-12);
  EXPECT_NEAR(caster.first_hit(ray, {0.1, 10})->distance, 0.45, 1e-12);
  EXPECT_FALSE(caster.first_hit(ray, {0.1, 0.4}).has_value());
  EXPECT_FALSE(caster.first_hit(ray, {0.5, 10}).has_value());
}

TEST(RayCaster, FindsTheRecordOfTheVoxel) {
  const std::vector<VoxelIndex> voxels = test::random_voxels(500, -30, 30, 5);
  const VoxelMap map = test::map_of_voxels(voxels);
  const RayCaster caster(map.finest());
  const VoxelFinder finder(map.finest());
  for (const VoxelIndex& voxel : voxels) {
    const Eigen::Vector3d center = center_of_voxel(voxel, kEdge);
    const auto hit = caster.first_hit({center + Eigen::Vector3d(0, 0, 0.06), {0, 0, -1}});
    ASSERT_TRUE(hit.has_value());
    EXPECT_EQ(hit->voxel, voxel);
    EXPECT_EQ(&map.finest().records()[hit->record], finder.find(voxel));
  }
}

TEST(RayCaster, NothingIsHitInAnEmptyLevelOrByARayWithoutDirection) {
  const VoxelLevel empty(kEdge, {}, {});
  EXPECT_FALSE(RayCaster(empty).first_hit({{0, 0, 0}, {1, 0, 0}}).has_value());
  const VoxelMap map = test::map_of_voxels({{0, 0, 0}, {3, 3, 3}});
  const RayCaster caster(map.finest());
  for (const double bad : {0.0, std::nan("")}) {
    EXPECT_FALSE(caster.first_hit({{0.15, 0.15, 0.15}, Eigen::Vector3d::Constant(bad)}).has_value());
  }
  EXPECT_FALSE(caster.first_hit({Eigen::Vector3d::Constant(std::nan("")), {1, 0, 0}}).has_value());
}

}  // namespace
}  // namespace vdbmap
