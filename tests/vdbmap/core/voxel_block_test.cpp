// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel_block.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include "tests/support/random_points.h"
#include "vdbmap/core/voxel_assembly.h"

namespace vdbmap {
namespace {

// The voxels in the order in which OpenVDB itself walks a tree of them.
std::vector<VoxelIndex> in_tree_order(const std::vector<VoxelIndex>& voxels) {
  openvdb::MaskTree tree;
  for (const VoxelIndex& voxel : voxels) tree.setValueOn(voxel);
  std::vector<VoxelIndex> ordered;
  for (auto it = tree.cbeginValueOn(); it; ++it) ordered.push_back(it.getCoord());
  return ordered;
}

std::vector<VoxelIndex> in_key_order(std::vector<VoxelIndex> voxels) {
  std::sort(voxels.begin(), voxels.end(), [](const VoxelIndex& a, const VoxelIndex& b) {
    return std::pair(block_of_voxel(a), key_in_block(a)) < std::pair(block_of_voxel(b), key_in_block(b));
  });
  return voxels;
}

class VoxelBlockOrder : public testing::TestWithParam<std::int32_t> {};

TEST_P(VoxelBlockOrder, IsTheOrderOfTheTree) {
  const std::vector<VoxelIndex> voxels = test::random_voxels(800, -GetParam(), GetParam() - 1, 1);
  EXPECT_EQ(in_key_order(voxels), in_tree_order(voxels));
}

TEST_P(VoxelBlockOrder, IsTheOrderOfTheWholeVoxelKey) {
  std::vector<VoxelIndex> voxels = test::random_voxels(800, -GetParam(), GetParam() - 1, 2);
  std::sort(voxels.begin(), voxels.end(),
            [](const VoxelIndex& a, const VoxelIndex& b) { return key_of_voxel(a) < key_of_voxel(b); });
  EXPECT_EQ(voxels, in_tree_order(voxels));
}

// Within leaves of 8, blocks of 128, root children of 4096, over many of these, and over the whole range.
INSTANTIATE_TEST_SUITE_P(Ranges, VoxelBlockOrder, testing::Values(9, 200, 5000, 50'000, kIndexLimit));

TEST(VoxelBlock, OriginIsTheLowestVoxelOfTheBlock) {
  for (const VoxelIndex& voxel : test::random_voxels(5000, -kIndexLimit, kIndexLimit - 1, 3)) {
    const VoxelIndex origin = origin_of_block(block_of_voxel(voxel));
    const VoxelIndex in_block = voxel - origin;
    EXPECT_EQ(block_of_voxel(origin), block_of_voxel(voxel));
    EXPECT_TRUE(VoxelIndex::minComponent(in_block, {0, 0, 0}) == VoxelIndex(0, 0, 0)) << in_block;
    EXPECT_TRUE(VoxelIndex::maxComponent(in_block, {127, 127, 127}) == VoxelIndex(127, 127, 127)) << in_block;
    EXPECT_EQ(origin & 127, VoxelIndex(0, 0, 0));
  }
}

TEST(VoxelBlock, KeysTellAllVoxelsOfABlockApart) {
  std::vector<bool> seen(1U << 21);
  for (std::int32_t x = -128; x < 0; ++x) {
    for (std::int32_t y = 0; y < 128; ++y) {
      for (std::int32_t z = 128; z < 256; ++z) seen[key_in_block({x, y, z})] = true;
    }
  }
  EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](bool was_seen) { return was_seen; }));
}

TEST(VoxelBlock, AKeyNamesTheLeafAndThePlaceInIt) {
  for (const VoxelIndex& voxel : test::random_voxels(2000, -5000, 5000, 4)) {
    const VoxelLeaf leaf(voxel);
    const KeyInBlock key = key_in_block(voxel);
    EXPECT_EQ(origin_of_block(block_of_voxel(voxel)) + leaf_origin_in_block(key), leaf.origin());
    EXPECT_EQ(offset_in_leaf(key), VoxelLeaf::coordToOffset(voxel));
    EXPECT_EQ(voxel_of_key(key_of_voxel(voxel)), voxel);
  }
}

TEST(VoxelBlock, LeavesHoldTheVoxelsOfTheBlock) {
  std::vector<VoxelIndex> voxels = in_key_order(test::random_voxels(2000, -128, -1, 5));
  BlockLeaves leaves(block_of_voxel(voxels.front()));
  for (const VoxelIndex& voxel : voxels) leaves.add(key_in_block(voxel));
  std::vector<VoxelIndex> found;
  for (const auto& leaf : leaves.take()) {
    for (auto it = leaf.cbeginValueOn(); it; ++it) found.push_back(it.getCoord());
  }
  EXPECT_EQ(found, voxels);
}

KeyedSums keyed(KeyInBlock key, std::int64_t count) { return {key, {.count = count}}; }

TEST(VoxelBlock, MergingAddsWhatBothHold) {
  const BlockSums merged = merge_blocks({keyed(1, 10), keyed(3, 30)}, {keyed(0, 1), keyed(3, 3), keyed(9, 9)});
  ASSERT_EQ(merged.size(), 4U);
  const std::vector<std::pair<KeyInBlock, std::int64_t>> expected = {{0, 1}, {1, 10}, {3, 33}, {9, 9}};
  for (std::size_t i = 0; i < merged.size(); ++i) {
    EXPECT_EQ(merged[i].key, expected[i].first);
    EXPECT_EQ(merged[i].sums.count, expected[i].second);
  }
}

TEST(VoxelBlock, MergingWithNothingChangesNothing) {
  EXPECT_EQ(merge_blocks({}, {keyed(4, 2)}).size(), 1U);
  EXPECT_EQ(merge_blocks({keyed(4, 2)}, {}).size(), 1U);
  EXPECT_TRUE(merge_blocks({}, {}).empty());
}

}  // namespace
}  // namespace vdbmap
