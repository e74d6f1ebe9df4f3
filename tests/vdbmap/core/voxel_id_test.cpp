// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel_id.h"

#include <set>

#include <gtest/gtest.h>

#include "tests/support/random_points.h"

namespace vdbmap {
namespace {

std::vector<VoxelIndex> corners_of_the_addressable_range() {
  std::vector<VoxelIndex> voxels;
  for (const std::int32_t x : {-kIndexLimit, -1, 0, kIndexLimit - 1}) {
    for (const std::int32_t y : {-kIndexLimit, -1, 0, kIndexLimit - 1}) {
      for (const std::int32_t z : {-kIndexLimit, -1, 0, kIndexLimit - 1}) voxels.emplace_back(x, y, z);
    }
  }
  return voxels;
}

TEST(VoxelId, RoundTripsAtTheLimitsOfTheRange) {
  for (const VoxelIndex& voxel : corners_of_the_addressable_range()) EXPECT_EQ(voxel_of_id(id_of_voxel(voxel)), voxel);
}

TEST(VoxelId, RoundTripsAnywhere) {
  for (const VoxelIndex& voxel : test::random_voxels(5000, -kIndexLimit, kIndexLimit - 1, 1)) {
    EXPECT_EQ(voxel_of_id(id_of_voxel(voxel)), voxel);
    EXPECT_EQ(parse_voxel_id(to_string(id_of_voxel(voxel))), id_of_voxel(voxel));
  }
}

TEST(VoxelId, NoTwoVoxelsShareOne) {
  std::set<VoxelId> ids;
  const std::vector<VoxelIndex> voxels = corners_of_the_addressable_range();
  for (const VoxelIndex& voxel : voxels) ids.insert(id_of_voxel(voxel));
  EXPECT_EQ(ids.size(), voxels.size());
}

TEST(VoxelId, HasTwentyOneBitsAnAxisCountedFromTheLowestIndex) {
  EXPECT_EQ(id_of_voxel({-kIndexLimit, -kIndexLimit, -kIndexLimit}), VoxelId{0});
  EXPECT_EQ(id_of_voxel({-kIndexLimit, -kIndexLimit, -kIndexLimit + 1}), VoxelId{1});
  EXPECT_EQ(id_of_voxel({-kIndexLimit, -kIndexLimit + 1, -kIndexLimit}), VoxelId{1ULL << 21});
  EXPECT_EQ(id_of_voxel({-kIndexLimit + 1, -kIndexLimit, -kIndexLimit}), VoxelId{1ULL << 42});
}

TEST(VoxelId, TextIsSixteenLowerCaseDigits) {
  EXPECT_EQ(to_string(VoxelId{0}), "0000000000000000");
  EXPECT_EQ(to_string(VoxelId{0xabc}), "0000000000000abc");
  EXPECT_EQ(to_string(id_of_voxel({kIndexLimit - 1, kIndexLimit - 1, kIndexLimit - 1})), "7fffffffffffffff");
}

TEST(VoxelId, TextThatIsNoIdIsNothing) {
  EXPECT_EQ(parse_voxel_id("7fffffffffffffff"), VoxelId{0x7fffffffffffffff});
  for (const char* text :
       {"", "0", "000000000000000", "00000000000000000", "0x00000000000000", "-000000000000001", "+000000000000001",
        " 000000000000001", "000000000000000 ", "00000000000000g0", "8000000000000000", "ffffffffffffffff"}) {
    EXPECT_EQ(parse_voxel_id(text), std::nullopt) << text;
  }
}

TEST(VoxelId, AStepLeadsToTheNeighbor) {
  const VoxelIndex voxel(0, -1, 7);
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        EXPECT_EQ(voxel_of_id(id_beside(id_of_voxel(voxel), x, y, z)), voxel.offsetBy(x, y, z));
      }
    }
  }
}

}  // namespace
}  // namespace vdbmap
