// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel_map.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/support/random_points.h"
#include "vdbmap/core/map_builder.h"

namespace vdbmap {
namespace {

TEST(VoxelMap, LevelsAreFoundByTheirVoxelSize) {
  const VoxelMap map = build_map(test::random_cloud(10, {Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()}, 6));
  EXPECT_EQ(find_level(map, 0.1), &map.finest());
  EXPECT_EQ(find_level(map, 1.0), &map.coarsest());
  EXPECT_EQ(find_level(map, 0.2), nullptr);
}

TEST(VoxelMap, ExtentIsTheBoxAroundTheVoxels) {
  PointCloud cloud;
  cloud.positions = {{5000.05, -3.01, 7}, {5001.01, -2.99, 7.05}};
  const std::optional<Extent> box = extent(build_map(cloud));
  ASSERT_TRUE(box.has_value());
  EXPECT_TRUE(box->min.isApprox(Eigen::Vector3d(5000.0, -3.1, 7.0), 1e-12));
  EXPECT_TRUE(box->max.isApprox(Eigen::Vector3d(5001.1, -2.9, 7.1), 1e-12));
}

TEST(VoxelMap, TheAnchorIsTheNearestMultipleOf1024Metres) {
  EXPECT_EQ(choose_anchor({511, -511, 0}), Eigen::Vector3d::Zero());
  EXPECT_FALSE(std::signbit(choose_anchor({0, -511, 0}).y()));
  EXPECT_EQ(choose_anchor({513, -513, 1536.5}), Eigen::Vector3d(1024, -1024, 2048));
}

TEST(VoxelMap, AnchorsAreWholeTiles) {
  EXPECT_NO_THROW(check_anchor({0, 0, 0}));
  EXPECT_NO_THROW(check_anchor({-64, 5'804'032, 128}));
  for (const Eigen::Vector3d& anchor : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(64, 96, 0),
                                        Eigen::Vector3d(0, 0, 1e-3), Eigen::Vector3d(640'000, 5'804'032, 0.001)}) {
    EXPECT_THROW(check_anchor(anchor), std::invalid_argument) << anchor.transpose();
  }
}

}  // namespace
}  // namespace vdbmap
