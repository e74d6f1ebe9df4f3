// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/segmentation/voxel_features.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/random_points.h"
#include "tests/support/sample_maps.h"

namespace vdbmap::parking {
namespace {

// A slope with something on it, over several blocks of columns and on both sides of the origin.
PointCloud slope() {
  PointCloud cloud = test::random_cloud(4000, {Eigen::Vector3d(-21, -9, 0), Eigen::Vector3d(19, 9, 9)}, 2);
  for (Eigen::Vector3d& point : cloud.positions) {
    point.z() = 0.1 * point.x() + (point.z() > 6 ? 1.5 * (point.z() - 6) : 0);
  }
  return cloud;
}

TEST(VoxelFeatures, AreHeightsOverTheLowestMeansAround) {
  const VoxelMap map = test::fine_map_of(slope());
  const VoxelLevel& level = map.finest();
  std::vector<Eigen::Vector3d> means;
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
    means.push_back(mean_of(level.records()[number], voxel, 0.1));
  });
  const auto lowest_around = [&](const Eigen::Vector3d& mean, int reach) {
    double lowest = mean.z();
    for (const Eigen::Vector3d& other : means) {
      const Eigen::Array2d columns = (mean.head<2>() / 0.5).array().floor() - (other.head<2>() / 0.5).array().floor();
      if (columns.abs().maxCoeff() <= reach) lowest = std::min(lowest, other.z());
    }
    return lowest;
  };
  const Rows features = voxel_features(level);
  ASSERT_EQ(features.rows(), static_cast<Eigen::Index>(means.size()));
  for (std::size_t i = 0; i < means.size(); i += 7) {
    const auto row = features.row(static_cast<Eigen::Index>(i));
    EXPECT_EQ(row[0], 1);
    EXPECT_NEAR(row[1], std::min(4.0, (means[i].z() - lowest_around(means[i], 2)) / 2), 1e-6);
    EXPECT_NEAR(row[2], std::min(4.0, (means[i].z() - lowest_around(means[i], 8)) / 2), 1e-6);
  }
}

TEST(VoxelFeatures, CountPointsByTheirLogarithm) {
  PointCloud cloud;
  for (int i = 0; i < 64; ++i) cloud.positions.emplace_back(0.05, 0.05, 0.05);
  cloud.positions.emplace_back(3.05, 0.05, 0.05);
  for (int i = 0; i < 10000; ++i) cloud.positions.emplace_back(7.05, 0.05, 0.05);
  const Rows features = voxel_features(test::fine_map_of(cloud).finest());
  ASSERT_EQ(features.rows(), 3);
  EXPECT_FLOAT_EQ(features(0, 3), 1);
  EXPECT_FLOAT_EQ(features(1, 3), 0);
  EXPECT_FLOAT_EQ(features(2, 3), 2);  // no more
}

TEST(VoxelFeatures, OfNoVoxelAreNone) { EXPECT_EQ(voxel_features(test::fine_map_of({}).finest()).rows(), 0); }

}  // namespace
}  // namespace vdbmap::parking
