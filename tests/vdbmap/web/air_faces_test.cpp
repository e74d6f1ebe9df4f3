// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/web/air_faces.h"

#include <array>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/random_points.h"
#include "tests/support/sample_maps.h"

namespace vdbmap {
namespace {

// The six neighbours, one by one, in a set.
AirFaces faces_by_search(const std::set<VoxelIndex>& voxels, const VoxelIndex& voxel) {
  const std::array<VoxelIndex, 6> beside = {VoxelIndex(-1, 0, 0), VoxelIndex(1, 0, 0),  VoxelIndex(0, -1, 0),
                                            VoxelIndex(0, 1, 0),  VoxelIndex(0, 0, -1), VoxelIndex(0, 0, 1)};
  AirFaces faces = 0;
  for (std::size_t i = 0; i < beside.size(); ++i) {
    if (!voxels.contains(voxel + beside[i])) faces |= static_cast<AirFaces>(1 << i);
  }
  return faces;
}

std::size_t expect_faces_of(const std::vector<VoxelIndex>& voxels) {
  const VoxelMap map = test::map_of_voxels(voxels);
  const std::set<VoxelIndex> set(voxels.begin(), voxels.end());
  const std::vector<AirFaces> faces = air_faces(map.finest());
  std::size_t num_hidden = 0;
  for_each_voxel(map.finest(), [&](const VoxelIndex& voxel, std::size_t record) {
    EXPECT_EQ(faces[record], faces_by_search(set, voxel)) << voxel;
    num_hidden += faces[record] == 0 ? 1 : 0;
  });
  EXPECT_EQ(faces.size(), voxels.size());
  return num_hidden;
}

TEST(AirFaces, AreThoseWithoutANeighbour) {
  // 24 voxels a side, three leaves, around the origin; four of five are occupied.
  EXPECT_GT(expect_faces_of(test::random_voxels(11'000, -12, 11, 3)), 100U);
}

TEST(AirFaces, OfScatteredVoxelsAreAllSix) { EXPECT_EQ(expect_faces_of({{0, 0, 0}, {9, 9, 9}, {-20, 7, 8}}), 0U); }

TEST(AirFaces, InsideOfACubeThereAreNone) {
  std::vector<VoxelIndex> cube;
  for (int x = -5; x < 5; ++x) {
    for (int y = -5; y < 5; ++y) {
      for (int z = -5; z < 5; ++z) cube.emplace_back(x, y, z);
    }
  }
  EXPECT_EQ(expect_faces_of(cube), 8U * 8 * 8);
}

}  // namespace
}  // namespace vdbmap
