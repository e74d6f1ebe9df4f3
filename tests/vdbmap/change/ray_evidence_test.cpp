// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/change/ray_evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/sample_maps.h"
#include "tests/support/threads.h"
#include "vdbmap/core/map_builder.h"

namespace vdbmap {
namespace {

using Voxels = std::set<std::tuple<int, int, int>>;

constexpr RayTrust kExact{.range_sigma = 0, .position_sigma = 0, .angle_sigma = 0, .clearance = 0, .max_range = 1e9};

Voxels voxels_of_tree(const VoxelTree& tree) {
  Voxels voxels;
  for (const VoxelLeaf& leaf : tree.leaves()) {
    for (auto it = leaf.getValueMask().beginOn(); it; ++it) {
      const VoxelIndex voxel = leaf.offsetToGlobalCoord(it.pos());
      voxels.emplace(voxel.x(), voxel.y(), voxel.z());
    }
  }
  return voxels;
}

// How long the way from a to b is inside of a voxel, by its slabs [m].
double way_inside(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const VoxelIndex& voxel, double size) {
  double begin = 0;
  double end = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = voxel[axis] * size;
    const double way = b[axis] - a[axis];
    const double enter = (low - a[axis]) / way;
    const double leave = (low + size - a[axis]) / way;
    begin = std::max(begin, std::min(enter, leave));
    end = std::min(end, std::max(enter, leave));
  }
  return std::max(0.0, end - begin) * (b - a).norm();
}

std::vector<MeasuredRay> random_rays(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-2.3, 2.3);
  std::vector<MeasuredRay> rays(count);
  for (MeasuredRay& ray : rays) {
    ray.origin = {place(random), place(random), place(random)};
    ray.end = {place(random), place(random), place(random)};
  }
  return rays;
}

// A map far from all rays: nothing of it is met.
VoxelMap far_map() { return test::map_of_voxels({{9000, 9000, 9000}}); }

TEST(RayEvidence, ARayPassesTheVoxelsThatBruteForceSaysItPasses) {
  const VoxelMap map = far_map();
  for (const MeasuredRay& ray : random_rays(60, 7)) {
    RayEvidence evidence({&map}, kExact);
    evidence.add(std::vector{ray});
    const Voxels passed = voxels_of_tree(evidence.seen_empty());
    for (int x = -24; x < 24; ++x) {
      for (int y = -24; y < 24; ++y) {
        for (int z = -24; z < 24; ++z) {
          const double inside = way_inside(ray.origin, ray.end, {x, y, z}, 0.1);
          const bool is_passed = passed.contains({x, y, z});
          // Corners that a ray touches are either.
          const double near = way_inside(ray.origin, ray.end + 1e-9 * (ray.end - ray.origin), {x, y, z}, 0.1 + 1e-9);
          if (inside > 1e-9) {
            ASSERT_TRUE(is_passed) << x << ' ' << y << ' ' << z << ", " << inside << " m inside";
          } else if (near == 0) {
            ASSERT_FALSE(is_passed) << x << ' ' << y << ' ' << z;
          }
        }
      }
    }
  }
}

TEST(RayEvidence, CutsAndThreadsChangeNothing) {
  const VoxelMap map = test::sample_map();
  const std::vector<MeasuredRay> rays = random_rays(5000, 3);
  const auto all_at_once = test::on_threads(1, [&] {
    RayEvidence evidence({&map}, {});
    evidence.add(rays);
    return std::pair(evidence.passes(0), voxels_of_tree(evidence.seen_empty()));
  });
  const auto in_pieces = test::on_threads(4, [&] {
    RayEvidence evidence({&map}, {});
    const std::span<const MeasuredRay> span(rays);
    for (std::size_t i = 0; i < rays.size(); i += 700)
      evidence.add(span.subspan(i, std::min<std::size_t>(700, rays.size() - i)));
    return std::pair(evidence.passes(0), voxels_of_tree(evidence.seen_empty()));
  });
  EXPECT_EQ(all_at_once, in_pieces);
  EXPECT_FALSE(all_at_once.second.empty());
}

// A level floor or an upright wall of points, 5 mm thick and dense.
VoxelMap plane_map(bool is_floor) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> along(-12, 12);
  std::normal_distribution<double> noise(0, 0.005);
  PointCloud cloud;
  for (int i = 0; i < 200000; ++i) {
    const double a = along(random);
    const double b = is_floor ? along(random) : along(random) / 6;
    const double thin = 0.05 + noise(random);
    cloud.positions.push_back(is_floor ? Eigen::Vector3d(a, b, thin) : Eigen::Vector3d(thin, a, b));
  }
  BuildOptions options = test::anchored(Eigen::Vector3d::Zero());
  return build_map(cloud, options);
}

std::uint64_t sum_of(const std::vector<std::uint32_t>& passes) {
  std::uint64_t sum = 0;
  for (const std::uint32_t count : passes) sum += count;
  return sum;
}

TEST(RayEvidence, RaysThatGrazeTheRoadSayNothingOfIt) {
  const VoxelMap road = plane_map(true);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.02);
  std::uniform_real_distribution<double> far(4, 11.5);
  std::vector<MeasuredRay> rays;
  for (int i = 0; i < 20000; ++i) {
    const double angle = i * 0.001;
    const double range = far(random);
    const Eigen::Vector3d sensor(0, 0, 0.45);  // 2 to 6 degrees above the road
    const Eigen::Vector3d on_road(range * std::cos(angle), range * std::sin(angle), 0.05);
    const Eigen::Vector3d way = (on_road - sensor).normalized();
    rays.push_back({sensor, on_road + noise(random) * way});
  }
  RayEvidence evidence({&road});
  evidence.add(rays);
  EXPECT_EQ(sum_of(evidence.passes(0)), 0U);
  for (const auto& [x, y, z] : voxels_of_tree(evidence.seen_empty())) ASSERT_GT(z, 0) << x << ' ' << y;
}

TEST(RayEvidence, RaysThroughAWallThatIsGoneCountWhereverTheyMeetIt) {
  const VoxelMap wall = plane_map(false);
  std::vector<MeasuredRay> rays;
  for (int y = -20; y < 20; ++y) {
    for (int i = 0; i < 5; ++i) rays.push_back({{-4, 0, 0.05}, {4, 0.2 * y + 0.1, 0.05 + 0.001 * i}});
  }
  RayEvidence evidence({&wall});
  evidence.add(rays);
  const VoxelFinder finder(wall.finest());
  for (int y = -20; y < 20; ++y) {  // half way: the middle of voxel y
    const VoxelRecord* record = finder.find({0, y, 0});
    ASSERT_NE(record, nullptr);
    const auto number = static_cast<std::size_t>(record - wall.finest().records().data());
    EXPECT_EQ(evidence.passes(0)[number], 5U) << y;
  }
}

TEST(RayEvidence, RaysThatEndInAWallOrJustBehindItSayNothingOfIt) {
  const VoxelMap wall = plane_map(false);
  std::vector<MeasuredRay> rays;
  for (int y = -20; y < 20; ++y) {
    rays.push_back({{-4, 0, 0.05}, {0.05, 0.1 * y, 0.05}});
    rays.push_back({{-4, 0, 0.05}, {0.09, 0.1 * y, 0.05}});
    rays.push_back({{-4, 0.1 * y, 0.05}, {-0.2, 0.1 * y, 0.05}});
  }
  RayEvidence evidence({&wall});
  evidence.add(rays);
  EXPECT_EQ(sum_of(evidence.passes(0)), 0U);
}

TEST(RayEvidence, WhatIsNoRayIsPassedOver) {
  const VoxelMap map = far_map();
  RayEvidence evidence({&map}, kExact);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  evidence.add(std::vector<MeasuredRay>{
      {{0, 0, 0}, {0, 0, 0}}, {{0, 0, 0}, {nan, 0, 0}}, {{nan, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {1e9, 0, 0}}});
  EXPECT_TRUE(voxels_of_tree(evidence.seen_empty()).empty());
}

TEST(RayEvidence, MapsOfTwoAnchorsOrNoneAreRefused) {
  const VoxelMap map = far_map();
  VoxelMap elsewhere = far_map();
  elsewhere.frame.anchor = {64, 0, 0};
  EXPECT_THROW(RayEvidence({&map, &elsewhere}), std::invalid_argument);
  EXPECT_THROW(RayEvidence({}), std::invalid_argument);
  EXPECT_THROW(RayEvidence({&map}, {.range_sigma = -1}), std::invalid_argument);
}

}  // namespace
}  // namespace vdbmap
