// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel_tree.h"

#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "tests/support/random_points.h"
#include "vdbmap/core/voxel_block.h"

namespace vdbmap {
namespace {

// The tree of leaves with these origins, each with its lowest voxel.
VoxelTree tree_of(std::vector<VoxelIndex> origins) {
  std::ranges::sort(origins, {}, [](const VoxelIndex& origin) { return key_of_voxel(origin); });
  LargeVector<VoxelLeaf> leaves;
  for (const VoxelIndex& origin : origins) leaves.emplace_back(origin).setValueOn(openvdb::Index{0});
  return VoxelTree(std::move(leaves));
}

std::vector<VoxelIndex> random_origins(std::size_t count, std::int32_t reach, std::int32_t step, unsigned seed) {
  std::vector<VoxelIndex> origins = test::random_voxels(count, -reach, reach - 1, seed);
  for (VoxelIndex& origin : origins) origin = VoxelIndex(origin.x() * step, origin.y() * step, origin.z() * step);
  return origins;
}

class VoxelTreeOf : public testing::TestWithParam<std::vector<VoxelIndex>> {};

TEST_P(VoxelTreeOf, FindsItsLeavesAndNoOthers) {
  const VoxelTree tree = tree_of(GetParam());
  std::map<VoxelIndex, const VoxelLeaf*> expected;
  for (const VoxelLeaf& leaf : tree.leaves()) expected[leaf.origin()] = &leaf;
  ASSERT_EQ(expected.size(), GetParam().size());
  for (const VoxelIndex& origin : GetParam()) {
    EXPECT_EQ(tree.find_leaf(origin.offsetBy(3, 0, 7)), expected.at(origin));
    for (int dx = -8; dx <= 8; dx += 8) {
      for (int dz = -8; dz <= 8; dz += 8) {
        const VoxelIndex near = origin.offsetBy(dx, -8, dz);
        const auto found = expected.find(near);
        EXPECT_EQ(tree.find_leaf(near), found == expected.end() ? nullptr : found->second) << near;
      }
    }
  }
}

// Crowded, scattered over the range, and where all leaves have the same place in their cubes of 2 x 2 x 2.
INSTANTIATE_TEST_SUITE_P(Places, VoxelTreeOf,
                         testing::Values(std::vector<VoxelIndex>(), std::vector<VoxelIndex>{{-8, 0, 8}},
                                         random_origins(700, 5, 8, 1), random_origins(5000, kIndexLimit / 8, 8, 2),
                                         random_origins(5000, 20, 16, 3), random_origins(5000, 20, 128, 4),
                                         random_origins(900, 100, 4096, 5)));

TEST(VoxelTree, ItsBoxIsThatOfItsVoxels) {
  EXPECT_TRUE(tree_of({}).voxel_box().empty());
  const VoxelTree tree = tree_of({{-16, 0, 800}, {8, -4096, 0}});
  EXPECT_EQ(tree.voxel_box(), openvdb::CoordBBox({-16, -4096, 0}, {8, 0, 800}));
}

}  // namespace
}  // namespace vdbmap
