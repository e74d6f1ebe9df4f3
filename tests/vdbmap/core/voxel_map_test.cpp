// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel_map.h"

#include <cmath>
#include <random>
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

// Multiples of a millimetre, on borders of voxels too, in a system of seven digits before the point.
TEST(VoxelMap, MeansOfSinglePointsHaveThePointsDigits) {
  for (const double voxel_size : {0.05, 0.1, 1.0}) {
    for (int i = 0; i < 500; ++i) {
      // Whole numbers divided are the doubles nearest to the decimals.
      const Eigen::Vector3d point((389'012'000.0 + i) / 1000, (5'804'032'000.0 - 7.0 * i) / 1000,
                                  (3.0 * i - 1000) / 1000);
      PointCloud cloud;
      cloud.positions = {point};
      BuildOptions options;
      options.voxel_sizes = {voxel_size};
      const VoxelMap map = build_map(cloud, options);
      for_each_voxel(map.finest(), [&](const VoxelIndex& voxel, std::size_t number) {
        EXPECT_EQ(mean_in_original_system(map.frame, map.finest().records()[number], voxel, voxel_size), point);
      });
    }
  }
}

TEST(VoxelMap, MeansInTheOriginalSystemMakeTheSameCodesAgain) {
  MapFrame frame;
  frame.anchor = Eigen::Vector3d(548'864, 5'804'032, -64);
  std::mt19937 random(1);
  std::uniform_int_distribution<int> code(0, kMeanSteps - 1);
  std::uniform_int_distribution<std::int32_t> index(-20'000, 20'000);
  for (int i = 0; i < 1000; ++i) {
    VoxelRecord record;
    record.count = 1;
    const VoxelIndex voxel(index(random), index(random), index(random));
    for (std::uint16_t& c : record.mean_code) c = static_cast<std::uint16_t>(code(random));
    PointCloud cloud;
    cloud.positions = {mean_in_original_system(frame, record, voxel, 0.1)};
    // Half a step is lost at most.
    EXPECT_LE((cloud.positions[0] - frame.anchor - mean_of(record, voxel, 0.1)).cwiseAbs().maxCoeff(),
              0.5 * 0.1 / kMeanSteps + 1e-9);
    BuildOptions options;
    options.voxel_sizes = {0.1};
    options.anchor = frame.anchor;
    const VoxelMap map = build_map(cloud, options);
    for_each_voxel(map.finest(), [&](const VoxelIndex& found, std::size_t number) {
      EXPECT_EQ(found, voxel);
      EXPECT_EQ(map.finest().records()[number].mean_code, record.mean_code);
    });
  }
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
