// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/tile_sums.h"

#include <algorithm>
#include <limits>
#include <map>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/random_points.h"
#include "vdbmap/core/error.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/store/sums_file.h"

namespace vdbmap {
namespace {

constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

// Points with colours, intensities of both signs and labels, on both sides of the axes, some in one voxel.
PointCloud cloud_of(std::size_t count, unsigned seed) {
  PointCloud cloud =
      test::random_cloud(count, Eigen::AlignedBox3d(Eigen::Vector3d(-80, -80, -1), Eigen::Vector3d(80, 80, 1)), seed);
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 3 == 0) cloud.positions[i] = cloud.positions[i / 2];
    cloud.intensities[i] = (cloud.intensities[i] - 0.5F) * 1e6F;
    cloud.labels.push_back(static_cast<std::uint16_t>(i % 4));
  }
  return cloud;
}

using PlainSums = std::map<VoxelKey, VoxelSums>;

PlainSums plain(const VoxelBlocks& blocks) {
  PlainSums sums;
  for (const auto& [block, content] : blocks) {
    for (const KeyedSums& voxel : content.sums) sums[key_of_voxel(block, voxel.key)] = voxel.sums;
  }
  return sums;
}

std::vector<LabelVotes> votes_of(const VoxelBlocks& blocks) {
  std::vector<LabelVotes> votes;
  for (const auto& [block, content] : blocks) votes.insert(votes.end(), content.votes.begin(), content.votes.end());
  return votes;
}

bool are_equal(const VoxelSums& a, const VoxelSums& b) {
  return a.count == b.count && a.position == b.position && a.product == b.product && a.num_colored == b.num_colored &&
         a.color == b.color && a.num_with_intensity == b.num_with_intensity && a.intensity_carry == b.intensity_carry &&
         a.intensity == b.intensity;
}

void expect_equal(const PlainSums& a, const PlainSums& b) {
  ASSERT_EQ(a.size(), b.size());
  for (auto x = a.begin(), y = b.begin(); x != a.end(); ++x, ++y) {
    EXPECT_EQ(x->first, y->first);
    EXPECT_TRUE(are_equal(x->second, y->second));
  }
}

SortedPoints sorted(const PointCloud& cloud) { return {cloud, 0, cloud.size(), Eigen::Isometry3d::Identity(), 10}; }

VoxelBlocks blocks_of(const PointCloud& cloud) {
  VoxelBlocks blocks;
  add_points(blocks, sorted(cloud));
  return blocks;
}

TEST(SumsFile, GivesWholeNumbersBack) {
  const test::TemporaryFolder folder;
  VoxelBlocks blocks = blocks_of(cloud_of(3000, 1));
  VoxelSums extreme;
  extreme.count = std::numeric_limits<std::int64_t>::max();
  extreme.position = {std::numeric_limits<std::int64_t>::min(), -1, 0};
  extreme.product.fill(std::numeric_limits<std::int64_t>::max());
  extreme.num_with_intensity = std::numeric_limits<std::uint32_t>::max();
  extreme.intensity_carry = std::numeric_limits<std::int32_t>::min();
  extreme.intensity = std::numeric_limits<std::int64_t>::min();
  blocks[block_of_voxel({-kIndexLimit, 0, kIndexLimit - 1})].sums = {{(1 << 21) - 1, extreme}};
  append_sums(folder / "sums", blocks);

  VoxelBlocks read;
  add_sums_of_file(folder / "sums", read);
  expect_equal(plain(read), plain(blocks));
  EXPECT_EQ(votes_of(read), votes_of(blocks));
  EXPECT_FALSE(votes_of(read).empty());
}

TEST(SumsFile, WhatIsAppendedIsAdded) {
  const test::TemporaryFolder folder;
  const VoxelBlocks a = blocks_of(cloud_of(3000, 1));
  const VoxelBlocks b = blocks_of(cloud_of(2000, 2));
  append_sums(folder / "sums", a);
  append_sums(folder / "sums", b);
  VoxelBlocks read;
  add_sums_of_file(folder / "sums", read);

  VoxelBlocks expected = a;
  add_points(expected, sorted(cloud_of(2000, 2)));
  expect_equal(plain(read), plain(expected));
  EXPECT_EQ(votes_of(read), votes_of(expected));
}

TEST(SumsFile, OneThatWasCutIsAnError) {
  const test::TemporaryFolder folder;
  append_sums(folder / "sums", blocks_of(cloud_of(10, 1)));
  std::filesystem::resize_file(folder / "sums", std::filesystem::file_size(folder / "sums") - 1);
  VoxelBlocks read;
  EXPECT_THROW(add_sums_of_file(folder / "sums", read), IoError);
}

// Voxels of a cloud that lie in a tile or in the leaves that begin within 1 m of it, one by one.
PlainSums sums_around(const PointCloud& cloud, const TileId& tile) {
  PlainSums all = plain(blocks_of(cloud));
  std::erase_if(all, [&](const auto& entry) {
    const VoxelIndex voxel = voxel_of_key(entry.first);
    const auto is_out = [](std::int32_t index, std::int32_t tile_index) {
      return index < 640 * tile_index - 16 || index >= 640 * (tile_index + 1) + 16;
    };
    return is_out(voxel.x(), tile.x) || is_out(voxel.y(), tile.y);
  });
  return all;
}

TEST(TileSums, EachTileHasItsVoxelsAndThoseAroundIt) {
  const test::TemporaryFolder folder;
  const PointCloud cloud = cloud_of(20'000, 3);
  TileSums sums({0.1, 1}, folder.path(), kNoLimit);
  sums.add(sorted(cloud));
  EXPECT_EQ(sums.tiles().size(), 16U);  // from -2 to 1 on both axes
  for (const TileId& tile : sums.tiles()) expect_equal(plain(sums.take(tile)), sums_around(cloud, tile));
  EXPECT_EQ(sums.num_spilled_bytes(), 0U);
}

TEST(TileSums, OfVoxelsThatDoNotFitIntoBlocksToo) {
  const test::TemporaryFolder folder;
  const PointCloud cloud = cloud_of(5000, 3);
  const SortedPoints points(cloud, 0, cloud.size(), Eigen::Isometry3d::Identity(), 5);  // 2.5 blocks a tile
  TileSums sums({0.2, 1}, folder.path(), kNoLimit);
  sums.add(points);
  VoxelBlocks all;
  add_points(all, points);
  std::size_t num_own = 0;
  for (const TileId& tile : sums.tiles()) {
    for (const auto& [key, voxel] : plain(sums.take(tile))) num_own += tile_of_voxel(voxel_of_key(key), 320) == tile;
  }
  EXPECT_EQ(num_own, plain(all).size());
}

TEST(TileSums, WhatWasSpilledComesBack) {
  const test::TemporaryFolder folder;
  TileSums spilled({0.1, 1}, folder.path(), 1 << 20);
  TileSums kept({0.1, 1}, folder.path(), kNoLimit);
  std::vector<PointCloud> clouds;
  for (unsigned seed = 0; seed < 5; ++seed) clouds.push_back(cloud_of(6000, seed));
  for (const PointCloud& cloud : clouds) {
    spilled.add(sorted(cloud));
    kept.add(sorted(cloud));
  }
  EXPECT_GT(spilled.num_spilled_bytes(), std::uint64_t{1} << 20);
  ASSERT_EQ(spilled.tiles(), kept.tiles());
  for (const TileId& tile : kept.tiles()) {
    const VoxelBlocks expected = kept.take(tile);
    const VoxelBlocks found = spilled.take(tile);
    expect_equal(plain(found), plain(expected));
    EXPECT_EQ(votes_of(found), votes_of(expected));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace vdbmap
