// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/coarse/pose_fit.h"

#include <gtest/gtest.h>

#include "registration/coarse/balanced_share.h"
#include "tests/support/sample_maps.h"
#include "tests/support/synthetic_scene.h"

namespace vdbmap::registration {
namespace {

constexpr double kRadius = 7;  // [m] of the surroundings that tell a normal's side

const SurfacePoints& village() {
  static const SurfacePoints points =
      surface_points(test::coarse_level(test::sample_scene(test::village(), 60, 1)), kRadius);
  return points;
}

// Other points of the same village.
const SurfacePoints& scan() {
  static const SurfacePoints points =
      surface_points(test::coarse_level(test::sample_scene(test::village(), 40, 7)), kRadius);
  return points;
}

double fit(const Eigen::Isometry3d& pose) { return pose_fit(scan(), village(), number_voxels(village(), 1), pose); }

Eigen::Isometry3d shifted(const Eigen::Vector3d& shift) { return Eigen::Isometry3d(Eigen::Translation3d(shift)); }

TEST(PoseFit, IsBestWhereTheScanIsFromToAMetre) {
  const double here = fit(Eigen::Isometry3d::Identity());
  EXPECT_GT(here, 0.8);
  EXPECT_GT(fit(shifted({0.4, -0.3, 0.2})), 0.8 * here);
  for (const Eigen::Vector3d& shift : {Eigen::Vector3d(6, 0, 0), Eigen::Vector3d(0, 5, 0), Eigen::Vector3d(0, 0, 3)}) {
    EXPECT_LT(fit(shifted(shift)), 0.7 * here) << shift.transpose();
  }
  EXPECT_LT(fit(Eigen::Isometry3d(Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitZ()))), 0.7 * here);
}

// Surfaces seen from the other side are others, also where they lie in the same place.
TEST(PoseFit, ASurfaceHasTwoSides) {
  SurfacePoints inside_out = village();
  for (Eigen::Vector3d& normal : inside_out.normals) normal = -normal;
  EXPECT_LT(pose_fit(scan(), inside_out, number_voxels(inside_out, 1), Eigen::Isometry3d::Identity()), 0.3);
}

TEST(PoseFit, NothingFitsWhereNothingIs) {
  EXPECT_EQ(fit(shifted({5000, 0, 0})), 0);
  EXPECT_EQ(fit(shifted({1e12, 0, 0})), 0);
  EXPECT_EQ(pose_fit({}, village(), number_voxels(village(), 1), Eigen::Isometry3d::Identity()), 0);
  EXPECT_EQ(pose_fit(scan(), {}, number_voxels({}, 1), Eigen::Isometry3d::Identity()), 0);
}

// 90 pieces of ground and 10 of a wall, of which those of the wall hold: along the normal of the wall, all.
TEST(BalancedShare, CountsDirectionsAlike) {
  std::vector<Eigen::Vector3d> normals(90, Eigen::Vector3d::UnitZ());
  normals.insert(normals.end(), 10, Eigen::Vector3d::UnitX());
  std::vector<bool> holds(90, false);
  holds.insert(holds.end(), 10, true);
  EXPECT_NEAR(balanced_share(normals, holds), 0.5, 0.01);
  EXPECT_EQ(balanced_share({}, {}), 0);
}

}  // namespace
}  // namespace vdbmap::registration
