// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel_query.h"

#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/support/sample_maps.h"
#include "vdbmap/core/map_builder.h"

namespace vdbmap {
namespace {

PointCloud random_cloud(const Eigen::Vector3d& center, double half_edge, std::size_t count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> offset(-half_edge, half_edge);
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    cloud.positions.push_back(center + Eigen::Vector3d(offset(random), offset(random), offset(random)));
  }
  return cloud;
}

// Brute force: the points of the cloud in the voxel of a level.
std::vector<Eigen::Vector3d> points_in(const PointCloud& cloud, const VoxelMap& map, const VoxelInfo& voxel) {
  std::vector<Eigen::Vector3d> found;
  for (const Eigen::Vector3d& point : cloud.positions) {
    const VoxelIndex index = voxel_of_point(point - map.frame.anchor, voxels_per_metre(voxel.voxel_size));
    if (index == voxel.index) found.push_back(point);
  }
  return found;
}

Moments moments_of(const std::vector<Eigen::Vector3d>& points) {
  Moments moments;
  for (const Eigen::Vector3d& point : points) {
    moments = merge(moments, {.count = 1, .mean = point, .scatter = Eigen::Matrix3d::Zero()});
  }
  return moments;
}

// Brute force: the ids of all voxels that share a point with the closed box.
std::vector<VoxelId> ids_in_box(const VoxelMap& map, const VoxelLevel& level, const Extent& box) {
  std::vector<VoxelId> ids;
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t) {
    const Eigen::Vector3d low = map.frame.anchor + corner_of_voxel(voxel, level.voxel_size());
    const Eigen::Vector3d high = low.array() + level.voxel_size();
    const bool touches = (low.array() <= box.max.array()).all() && (high.array() > box.min.array()).all();
    if (touches) ids.push_back(id_of_voxel(voxel));
  });
  return ids;
}

std::vector<VoxelId> ids_of(const std::vector<VoxelInfo>& voxels) {
  std::vector<VoxelId> ids;
  for (const VoxelInfo& voxel : voxels) ids.push_back(voxel.id);
  return ids;
}

class VoxelQuery : public testing::Test {
 protected:
  PointCloud cloud_ = random_cloud(test::kUtm, 2.0, 20'000);
  VoxelMap map_ = build_map(cloud_, {.voxel_sizes = {0.1, 1.0}, .anchor = test::kUtm, .epsg = {}, .epoch = {}});
};

TEST_F(VoxelQuery, TheVoxelAtAPointHoldsTheMomentsOfItsPoints) {
  for (const VoxelLevel& level : map_.levels) {
    for (std::size_t i = 0; i < cloud_.size(); i += 997) {
      const auto voxel = voxel_at(map_, level, cloud_.positions[i]);
      ASSERT_TRUE(voxel);
      const Moments expected = moments_of(points_in(cloud_, map_, *voxel));
      EXPECT_EQ(voxel->voxel_size, level.voxel_size());
      EXPECT_EQ(voxel->count, expected.count);
      const double step = level.voxel_size() / kMeanSteps;
      EXPECT_TRUE(((voxel->mean - expected.mean).array().abs() < 2 * step).all());
      EXPECT_TRUE(voxel->covariance.isApprox(expected.covariance(), 0x1p-8));  // elements have 8 bits
      EXPECT_TRUE(voxel->features.eigenvalues.isApprox(eigen_features(expected.covariance()).eigenvalues, 0x1p-7));
      EXPECT_NEAR(voxel->normal.norm(), 1, 1e-6);
    }
  }
}

TEST_F(VoxelQuery, TheIdLeadsToTheSameVoxel) {
  const auto by_point = voxel_at(map_, map_.finest(), cloud_.positions.front());
  ASSERT_TRUE(by_point);
  const auto by_id = voxel_with_id(map_, map_.finest(), by_point->id);
  ASSERT_TRUE(by_id);
  EXPECT_EQ(by_id->index, by_point->index);
  EXPECT_EQ(by_id->mean, by_point->mean);
  EXPECT_EQ(by_id->count, by_point->count);
}

TEST_F(VoxelQuery, WhereNothingIsThereIsNoVoxel) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(voxel_at(map_, map_.finest(), test::kUtm + Eigen::Vector3d(3, 0, 0)));
  EXPECT_FALSE(voxel_at(map_, map_.finest(), Eigen::Vector3d::Zero()));  // beyond all indices
  EXPECT_FALSE(voxel_at(map_, map_.finest(), Eigen::Vector3d(nan, 0, 0)));
  EXPECT_FALSE(voxel_with_id(map_, map_.finest(), id_of_voxel({30, 0, 0})));
  EXPECT_FALSE(voxel_with_id(map_, map_.finest(), VoxelId{0}));
}

TEST_F(VoxelQuery, ABoxHoldsTheVoxelsThatTouchIt) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> offset(-2.5, 2.5);
  const auto corner = [&]() -> Eigen::Vector3d {
    return test::kUtm + Eigen::Vector3d(offset(random), offset(random), offset(random));
  };
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d a = corner();
    const Eigen::Vector3d b = corner();
    const Extent box{a.cwiseMin(b), a.cwiseMax(b)};
    for (const VoxelLevel& level : map_.levels) {
      EXPECT_EQ(ids_of(voxels_in_box(map_, level, box)), ids_in_box(map_, level, box));
    }
  }
}

TEST_F(VoxelQuery, ABoxAroundEverythingHoldsEverythingInOrder) {
  const Extent all{Eigen::Vector3d::Constant(-1e12), Eigen::Vector3d::Constant(1e12)};
  const std::vector<VoxelInfo> voxels = voxels_in_box(map_, map_.finest(), all);
  EXPECT_EQ(ids_of(voxels), ids_in_box(map_, map_.finest(), all));
  EXPECT_EQ(voxels.size(), map_.finest().size());
}

TEST_F(VoxelQuery, ABoxWithoutVolumeIsAPoint) {
  const Eigen::Vector3d& point = cloud_.positions.front();
  const std::vector<VoxelInfo> voxels = voxels_in_box(map_, map_.finest(), {point, point});
  ASSERT_EQ(voxels.size(), 1U);
  EXPECT_EQ(voxels[0].id, voxel_at(map_, map_.finest(), point)->id);
}

TEST_F(VoxelQuery, ABoxFarAwayIsEmpty) {
  const Eigen::Vector3d far = test::kUtm + Eigen::Vector3d::Constant(1e7);
  EXPECT_TRUE(voxels_in_box(map_, map_.finest(), {far, 2 * far}).empty());
  EXPECT_TRUE(voxels_in_box(map_, map_.finest(), {-2 * far, -far}).empty());
}

TEST_F(VoxelQuery, ABoxOfSwappedCornersIsRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(voxels_in_box(map_, map_.finest(), {{0, 1, 0}, {1, 0, 1}}), std::invalid_argument);
  EXPECT_THROW(voxels_in_box(map_, map_.finest(), {{0, nan, 0}, {1, 0, 1}}), std::invalid_argument);
}

TEST(VoxelInfo, AttributesOfTheMapAreDecoded) {
  PointCloud cloud;
  cloud.positions = {{0.05, 0.05, 0.05}, {5.05, 0.05, 0.05}};
  cloud.colors = {{65535, 0, 32896}, {0, 0, 0}};
  cloud.intensities = {0.25F, 0.75F};
  cloud.labels = {40, 0};
  VoxelMap map = build_map(cloud, {.voxel_sizes = {0.1}, .anchor = {}, .epsg = {}, .epoch = 3});
  map.label_scheme = LabelScheme::kSemanticKitti;
  const auto first = voxel_at(map, map.finest(), cloud.positions[0]);
  const auto second = voxel_at(map, map.finest(), cloud.positions[1]);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->linear_color->x(), 1.0);
  EXPECT_EQ(first->color->r, 65535);
  EXPECT_EQ(first->color->g, 0);
  EXPECT_NEAR(first->color->b, 32896, 3);  // rounded to 1/65535 in linear light
  EXPECT_EQ(first->intensity, 0.25F);
  EXPECT_EQ(second->intensity, 0.75F);
  EXPECT_EQ(first->label, 40);
  EXPECT_EQ(first->label_name, "road");
  EXPECT_EQ(second->label, kNoLabel);
  EXPECT_EQ(second->label_name, "no class");
  EXPECT_EQ(second->first_epoch, 3);
  EXPECT_EQ(second->last_epoch, 3);
}

TEST(VoxelInfo, AttributesThatTheMapLacksAreEmpty) {
  PointCloud cloud;
  cloud.positions = {{0.05, 0.05, 0.05}};
  const VoxelMap map = build_map(cloud);
  const auto voxel = voxel_at(map, map.finest(), cloud.positions[0]);
  ASSERT_TRUE(voxel);
  EXPECT_FALSE(voxel->label);
  EXPECT_EQ(voxel->label_name, "");
  EXPECT_FALSE(voxel->linear_color || voxel->color || voxel->intensity || voxel->first_epoch || voxel->last_epoch);
  EXPECT_EQ(voxel->covariance, Eigen::Matrix3d::Zero());
}

}  // namespace
}  // namespace vdbmap
