// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/coarse/surface_points.h"

#include <gtest/gtest.h>

#include "tests/support/sample_maps.h"
#include "tests/support/synthetic_scene.h"
#include "vdbmap/core/map_builder.h"

namespace vdbmap::registration {
namespace {

// Share of the flat points whose normal points to where `inside` is, as seen from them.
double share_facing(const SurfacePoints& points, const Eigen::Vector3d& inside) {
  double facing = 0;
  double count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points.planarities[i] < 0.5) continue;  // edges face nowhere
    facing += points.normals[i].dot(inside - points.positions[i]) > 0;
    ++count;
  }
  EXPECT_GT(count, 100);
  return facing / count;
}

TEST(SurfacePoints, FaceTheInsideOfARoomWhateverWayItIsTurned) {
  const PointCloud walls = test::sample_scene(test::box({-6, -4, 0}, {6, 4, 3}), 100, 1);
  const Eigen::Vector3d middle(0, 0, 1.5);
  Eigen::Isometry3d turned = Eigen::Isometry3d::Identity();
  for (const double angle : {0.0, 1.0, 2.0, 3.0}) {
    turned.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    EXPECT_EQ(share_facing(surface_points(test::coarse_level(test::moved(walls, turned)), 7), turned * middle), 1.0);
  }
}

TEST(SurfacePoints, HaveOneEntryAVoxelAtItsMean) {
  PointCloud cloud;
  cloud.positions = {{0.2, 0.2, 0.2}, {0.4, 0.2, 0.2}, {7.5, 0.5, 0.5}};
  const SurfacePoints points = surface_points(test::coarse_level(cloud), 5);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_NEAR((points.positions[0] - Eigen::Vector3d(0.3, 0.2, 0.2)).norm(), 0, 1e-4);
  EXPECT_NEAR(points.normals[1].norm(), 1, 1e-9);
}

}  // namespace
}  // namespace vdbmap::registration
