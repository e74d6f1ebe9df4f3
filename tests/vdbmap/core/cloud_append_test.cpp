// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/cloud_append.h"

#include <gtest/gtest.h>

namespace vdbmap {
namespace {

PointCloud cloud_at(double x, bool has_rings) {
  PointCloud cloud;
  cloud.positions = {{x, 0, 0}, {x, 1, 0}};
  cloud.intensities = {static_cast<float>(x), 0.5F};
  if (has_rings) cloud.rings = {1, 2};
  return cloud;
}

TEST(AppendCloud, MovesThePointsAndKeepsTheAttributes) {
  PointCloud cloud;
  append_cloud(cloud, cloud_at(1, true), Eigen::Isometry3d::Identity());
  append_cloud(cloud, cloud_at(2, true), Eigen::Isometry3d(Eigen::Translation3d(0, 0, 5)));
  EXPECT_EQ(cloud.positions, (std::vector<Eigen::Vector3d>{{1, 0, 0}, {1, 1, 0}, {2, 0, 5}, {2, 1, 5}}));
  EXPECT_EQ(cloud.intensities, (std::vector<float>{1, 0.5F, 2, 0.5F}));
  EXPECT_EQ(cloud.rings, (std::vector<std::uint16_t>{1, 2, 1, 2}));
}

TEST(AppendCloud, DropsAnAttributeThatAPartLacks) {
  PointCloud cloud;
  append_cloud(cloud, cloud_at(1, true), Eigen::Isometry3d::Identity());
  append_cloud(cloud, cloud_at(2, false), Eigen::Isometry3d::Identity());
  append_cloud(cloud, cloud_at(3, true), Eigen::Isometry3d::Identity());
  EXPECT_EQ(cloud.size(), 6U);
  EXPECT_TRUE(cloud.rings.empty());
  EXPECT_EQ(cloud.intensities.size(), 6U);
}

TEST(AppendCloud, NothingChangesNothing) {
  PointCloud cloud = cloud_at(1, true);
  append_cloud(cloud, {}, Eigen::Isometry3d::Identity());
  EXPECT_EQ(cloud.rings.size(), 2U);
}

}  // namespace
}  // namespace vdbmap
