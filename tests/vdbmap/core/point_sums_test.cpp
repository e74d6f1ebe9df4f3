// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/point_sums.h"

#include <gtest/gtest.h>

#include "tests/support/brute_force.h"
#include "tests/support/random_points.h"

namespace vdbmap {
namespace {

constexpr double kVoxelSize = 0.1;  // [m]

std::vector<Eigen::Vector3d> points_in(const VoxelIndex& voxel, std::size_t count, unsigned seed) {
  const Eigen::Vector3d corner = corner_of_voxel(voxel, kVoxelSize);
  return test::random_points(count, {corner, corner + Eigen::Vector3d::Constant(kVoxelSize)}, seed);
}

VoxelRecord record_of_points(const std::vector<Eigen::Vector3d>& points, const VoxelIndex& voxel) {
  VoxelRecord record;
  set_moments(record, test::two_pass_moments(points), voxel, kVoxelSize);
  return record;
}

TEST(PointSums, OfSeveralVoxelsAreThoseOfAllTheirPoints) {
  const Eigen::Vector3d origin(5.15, -2.05, 0.35);  // [m]
  std::vector<Eigen::Vector3d> all;
  PointSums total;
  unsigned seed = 0;
  for (const VoxelIndex& voxel : {VoxelIndex(51, -21, 3), VoxelIndex(52, -21, 3), VoxelIndex(50, -20, 4)}) {
    const std::vector<Eigen::Vector3d> points = points_in(voxel, 40 + 100 * seed, seed);
    const VoxelRecord record = record_of_points(points, voxel);
    total.add(sums_of(record, mean_of(record, voxel, kVoxelSize) - origin));
    all.insert(all.end(), points.begin(), points.end());
    ++seed;
  }

  const Moments expected = test::two_pass_moments(all);
  const Moments moments = moments_of(total);
  EXPECT_EQ(moments.count, expected.count);
  EXPECT_TRUE((origin + moments.mean).isApprox(expected.mean, 1e-6));  // means are kept in steps of 1.5 um
  EXPECT_TRUE(moments.scatter.isApprox(expected.scatter, 1.0 / 256));  // covariances in 8 significant bits
}

TEST(PointSums, OfOnePointHaveNoScatter) {
  const VoxelIndex voxel(1, 2, 3);
  const VoxelRecord record = record_of_points({center_of_voxel(voxel, kVoxelSize)}, voxel);
  const Moments moments = moments_of(sums_of(record, {0.25, -0.5, 2}));
  EXPECT_EQ(moments.count, 1);
  EXPECT_EQ(moments.mean, Eigen::Vector3d(0.25, -0.5, 2));
  EXPECT_EQ(moments.scatter, Eigen::Matrix3d::Zero());
}

}  // namespace
}  // namespace vdbmap
