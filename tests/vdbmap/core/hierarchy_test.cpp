// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/hierarchy.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/brute_force.h"
#include "tests/support/random_points.h"
#include "tests/support/sample_maps.h"
#include "tests/support/threads.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/core/voxel_sums.h"

namespace vdbmap {
namespace {

// Across leaves and blocks, on both sides of every axis.
const Eigen::AlignedBox3d kTwoBlocks(Eigen::Vector3d(-13.1, -2.2, -1.1), Eigen::Vector3d(3.3, 2.4, 1.2));

VoxelMap map_with_levels(const PointCloud& cloud, const std::vector<double>& voxel_sizes) {
  BuildOptions options;
  options.voxel_sizes = voxel_sizes;
  options.anchor = Eigen::Vector3d::Zero();
  return build_map(cloud, options);
}

// A stored mean is off by half its step and half a quantum of the points.
double mean_error(double voxel_size) { return 0.5 * voxel_size * (1.0 / kMeanSteps + 1.0 / kQuantaPerVoxel); }

// Records of a merged level against the points. Means of the fine level are off by mean_error(), which shifts offsets
// of at most one edge; covariances of both levels are rounded to 8 or 16 bits, the finer ones below a quarter of
// their edge squared (times 2 for two points).
void expect_moments_of_points(const VoxelLevel& level, const PointCloud& cloud, double fine_size) {
  const double size = level.voxel_size();
  const double mean_tolerance = mean_error(fine_size) + mean_error(size);
  const double covariance_tolerance = 4 * size * mean_error(fine_size) + 0x1p-8 * fine_size * fine_size / 2;
  const test::PointsByVoxel voxels = test::points_by_voxel(cloud.positions, size);
  ASSERT_EQ(level.size(), voxels.size());
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
    const VoxelRecord& record = level.records()[number];
    const Moments expected = test::two_pass_moments(cloud.positions, voxels.at(voxel));
    EXPECT_EQ(record.count, expected.count);
    EXPECT_LT((mean_of(record, voxel, size) - expected.mean).cwiseAbs().maxCoeff(), mean_tolerance);
    const Eigen::Array33d error = (covariance_of(record) - expected.covariance()).array().abs();
    EXPECT_TRUE((error <= covariance_tolerance +
                              (expected.count <= 256 ? 0x1p-8 : 0x1p-16) * expected.covariance().array().abs())
                    .all())
        << error << "\n> " << covariance_tolerance;
  });
}

struct Step {
  double fine_size;
  double coarse_size;
};

class HierarchyStep : public testing::TestWithParam<Step> {};

TEST_P(HierarchyStep, ALevelHasTheMomentsOfItsPoints) {
  const auto [fine_size, coarse_size] = GetParam();
  const PointCloud cloud = test::random_cloud(30'000, kTwoBlocks, 1);
  expect_moments_of_points(map_with_levels(cloud, {fine_size, coarse_size}).coarsest(), cloud, fine_size);
}

TEST_P(HierarchyStep, ALevelIsTheOneBuiltFromThePointsDirectly) {
  const auto [fine_size, coarse_size] = GetParam();
  const PointCloud cloud = test::random_cloud(30'000, kTwoBlocks, 2);
  const VoxelMap two_levels = map_with_levels(cloud, {fine_size, coarse_size});
  const VoxelMap one_level = map_with_levels(cloud, {coarse_size});
  const VoxelLevel& merged = two_levels.coarsest();
  const VoxelLevel& direct = one_level.finest();
  ASSERT_TRUE(test::same_voxels(merged, direct));
  for (std::size_t i = 0; i < direct.size(); ++i) {
    EXPECT_EQ(merged.records()[i].count, direct.records()[i].count);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(merged.records()[i].mean_code[axis], direct.records()[i].mean_code[axis], 2);
    }
    EXPECT_TRUE(color_of(merged.records()[i]).isApprox(color_of(direct.records()[i]), 0x1p-7));  // both rounded
    EXPECT_NEAR(merged.channels().intensities[i], direct.channels().intensities[i], 1e-4);       // of 256: floats
  }
}

TEST_P(HierarchyStep, CountsAddUp) {
  const auto [fine_size, coarse_size] = GetParam();
  const VoxelMap map = map_with_levels(test::random_cloud(30'000, kTwoBlocks, 3), {fine_size, coarse_size});
  EXPECT_EQ(num_points(map.finest()), 30'000U);
  EXPECT_EQ(num_points(map.coarsest()), 30'000U);
}

// Factors 2, 3, 10 and 128: of leaves of 8 voxels, the second and third are not whole; the last has many.
INSTANTIATE_TEST_SUITE_P(Factors, HierarchyStep,
                         testing::Values(Step{0.1, 0.2}, Step{64.0 / 600, 0.32}, Step{0.1, 1.0}, Step{0.0625, 8.0}));

TEST(Hierarchy, ThreeLevelsAreEachAMergeOfThePoints) {
  const PointCloud cloud = test::random_cloud(30'000, kTwoBlocks, 4);
  const VoxelMap map = map_with_levels(cloud, {0.1, 0.2, 1});
  ASSERT_EQ(map.levels.size(), 3U);
  EXPECT_DOUBLE_EQ(map.levels[1].voxel_size(), 0.2);
  EXPECT_DOUBLE_EQ(map.levels[2].voxel_size(), 1.0);
  expect_moments_of_points(map.levels[1], cloud, 0.1);
  expect_moments_of_points(map.levels[2], cloud, 0.2 + 0.1);  // the errors of both levels below
}

TEST(Hierarchy, ALevelOfOnlyOneVoxelHoldsAll) {
  const PointCloud cloud = test::random_cloud(5000, {Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(7, 7, 7)}, 5);
  const VoxelMap map = map_with_levels(cloud, {0.1, 8});
  ASSERT_EQ(map.coarsest().size(), 1U);
  EXPECT_EQ(map.coarsest().records()[0].count, 5000U);
  expect_moments_of_points(map.coarsest(), cloud, 0.1);
}

TEST(Hierarchy, EpochsOfAParentSpanThoseOfItsChildren) {
  const VoxelMap source =
      map_with_levels(test::random_cloud(200, {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 1, 1)}, 6), {0.1});
  VoxelChannels channels;
  for (std::size_t i = 0; i < source.finest().size(); ++i) {
    channels.first_epochs.push_back(static_cast<std::int32_t>(i) - 5);
    channels.last_epochs.push_back(static_cast<std::int32_t>(2 * i));
  }
  const std::span<const VoxelRecord> records = source.finest().records();
  const std::span<const VoxelLeaf> leaves = source.finest().leaves();
  const VoxelLevel fine(0.1, {leaves.begin(), leaves.end()}, {records.begin(), records.end()}, channels);

  const VoxelLevel coarse = coarsen(fine, 10);
  ASSERT_EQ(coarse.size(), 1U);
  EXPECT_EQ(coarse.channels().first_epochs, std::vector<std::int32_t>{-5});
  EXPECT_EQ(coarse.channels().last_epochs, std::vector<std::int32_t>{static_cast<std::int32_t>(2 * fine.size()) - 2});
}

TEST(Hierarchy, DoesNotDependOnTheNumberOfThreads) {
  // Over a thousand leaves, so that parents are gathered by several tasks.
  const VoxelMap map = map_with_levels(test::random_cloud(60'000, kTwoBlocks, 7), {0.05});
  ASSERT_GT(map.finest().leaves().size(), 1000U);
  const auto coarse_map = [&] {
    VoxelMap coarse;
    coarse.levels.push_back(coarsen(map.finest(), 10));
    return coarse;
  };
  const VoxelMap on_one = test::on_threads(1, coarse_map);
  EXPECT_EQ(test::difference(test::on_threads(2, coarse_map), on_one), "");
  EXPECT_EQ(test::difference(test::on_threads(4, coarse_map), on_one), "");
}

}  // namespace
}  // namespace vdbmap
