// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/segmentation/segment.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <gtest/gtest.h>

#include "parking/segmentation/default_weights.h"
#include "tests/support/random_points.h"
#include "tests/support/sample_maps.h"
#include "tests/support/synthetic_scene.h"
#include "vdbmap/core/hierarchy.h"
#include "vdbmap/core/map_builder.h"

namespace vdbmap::parking {
namespace {

const NetworkWeights& shipped() {
  static const NetworkWeights kNetwork = *read_network(default_weights());
  return kNetwork;
}

PointCloud sampled_village() { return test::sample_scene(test::village(), 25, 1); }

VoxelMap map_with_levels(std::vector<double> sizes) {
  BuildOptions options = test::anchored(Eigen::Vector3d::Zero());
  options.voxel_sizes = std::move(sizes);
  return build_map(sampled_village(), options);
}

// 300 m of road with boxes on it, turned, on both sides of the anchor.
VoxelMap long_street() {
  PointCloud cloud = test::random_cloud(60'000, {Eigen::Vector3d(-150, -6, 0), Eigen::Vector3d(150, 6, 0.03)}, 3);
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector3d corner(-148 + 7.4 * i, i % 2 == 0 ? -5.5 : 3.6, 0);
    const PointCloud car = test::sample_scene(test::box(corner, corner + Eigen::Vector3d(4.2, 1.8, 1.5)), 60, 4);
    cloud.positions.insert(cloud.positions.end(), car.positions.begin(), car.positions.end());
  }
  const Eigen::AngleAxisd turn(0.5, Eigen::Vector3d::UnitZ());
  for (Eigen::Vector3d& point : cloud.positions) point = turn * point;
  return test::fine_map_of(cloud);
}

TEST(Segment, WindowsChangeNothing) {
  const VoxelMap map = long_street();
  const auto whole = segment(map.finest(), shipped());
  SegmentOptions options;
  options.voxels_at_once = 5'000;
  const auto cut = segment(map.finest(), shipped(), options);
  ASSERT_EQ(cut.size(), whole.size());
  std::size_t num_different = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) num_different += whole[i] != cut[i] ? 1 : 0;
  EXPECT_LE(static_cast<double>(num_different), 1e-4 * static_cast<double>(whole.size()));
  // More than one answer, else nothing was compared.
  EXPECT_GT(std::ranges::count(whole, SurfaceClass::kGround), 1000);
  EXPECT_GT(std::ranges::count(whole, SurfaceClass::kVehicle), 1000);
}

TEST(Segment, OfNothingIsNothing) {
  const VoxelMap map = test::fine_map_of({});
  EXPECT_TRUE(segment(map.finest(), shipped()).empty());
}

TEST(LabelMap, KnowsTheFloorOfAVillageAndGivesParentsTheLabelOfMostPoints) {
  VoxelMap map = map_with_levels({0.1, 1.0});
  label_map(map, shipped());
  EXPECT_EQ(map.label_scheme, LabelScheme::kSemanticKitti);
  const VoxelLevel& fine = map.finest();
  ASSERT_EQ(fine.channels().labels.size(), fine.size());
  std::size_t floor = 0, known = 0;
  for_each_voxel(fine, [&](const VoxelIndex& voxel, std::size_t number) {
    if (voxel.z() > 0) return;
    ++floor;
    known += fine.channels().labels[number] == semantic_kitti_label(SurfaceClass::kGround) ? 1 : 0;
  });
  EXPECT_GT(static_cast<double>(known), 0.9 * static_cast<double>(floor));

  const VoxelLevel& coarse = map.coarsest();
  ASSERT_EQ(coarse.channels().labels.size(), coarse.size());
  for_each_voxel(coarse, [&](const VoxelIndex& voxel, std::size_t number) {
    std::map<std::int32_t, std::uint64_t> votes;
    std::uint64_t most = 0;
    const VoxelFinder finder(fine);
    for (auto child = openvdb::CoordBBox(first_child_of_voxel(voxel, 10), first_child_of_voxel(voxel, 10).offsetBy(9))
                          .beginXYZ();
         child; ++child) {
      if (const VoxelRecord* record = finder.find(*child)) {
        auto& vote = votes[fine.channels().labels[static_cast<std::size_t>(record - fine.records().data())]];
        vote += record->count;
        most = std::max(most, vote);
      }
    }
    EXPECT_EQ(votes[coarse.channels().labels[number]], most);
  });
}

TEST(LabelMap, GivesSmallerVoxelsTheClassOfTheirTenCentimetres) {
  VoxelMap map = map_with_levels({0.05, 0.5});
  VoxelMap tens = map_with_levels({0.1});
  label_map(map, shipped());
  label_map(tens, shipped());
  const VoxelFinder finder(tens.finest());
  std::size_t num_equal = 0;
  for_each_voxel(map.finest(), [&](const VoxelIndex& voxel, std::size_t number) {
    const auto parent = finder.find(parent_of_voxel(voxel, 2)) - tens.finest().records().data();
    const std::int32_t label = tens.finest().channels().labels[static_cast<std::size_t>(parent)];
    num_equal += map.finest().channels().labels[number] == label ? 1 : 0;
  });
  // Means of merged voxels are rounded once more.
  EXPECT_GE(static_cast<double>(num_equal), 0.999 * static_cast<double>(map.finest().size()));
}

TEST(LabelMap, RefusesVoxelsThatTenCentimetresAreNoMultipleOf) {
  VoxelMap map = map_with_levels({0.2, 1.0});
  EXPECT_THROW(label_map(map, shipped()), std::invalid_argument);
  EXPECT_TRUE(map.finest().channels().labels.empty());
}

TEST(PointLabels, AreThoseOfTheVoxelsAndNoneFarAway) {
  PointCloud cloud = sampled_village();
  VoxelMap map = test::fine_map_of(cloud);
  label_map(map, shipped());
  cloud.positions.emplace_back(1e9, 0, 0);
  const auto labels = point_labels(cloud, shipped());
  ASSERT_EQ(labels.size(), cloud.size());
  EXPECT_EQ(labels.back(), kNoLabel);
  const VoxelFinder finder(map.finest());
  for (std::size_t i = 0; i + 1 < cloud.size(); i += 11) {
    const auto number = finder.find(voxel_of_point(cloud.positions[i], 10)) - map.finest().records().data();
    ASSERT_EQ(labels[i], map.finest().channels().labels[static_cast<std::size_t>(number)]);
  }
}

// Each point lies on borders of voxels, and is rounded to either side of them; next to its voxel there is none.
TEST(PointLabels, AreKnownOnTheBordersOfVoxelsToo) {
  PointCloud cloud;
  for (int x = 0; x < 100; ++x) {
    for (int y = 0; y < 50; ++y) cloud.positions.emplace_back(548864 + 0.3 * x, 5804032 + 0.3 * y, 52.3);
  }
  const auto labels = point_labels(cloud, shipped());
  EXPECT_EQ(std::ranges::count(labels, kNoLabel), 0);
}

}  // namespace
}  // namespace vdbmap::parking
