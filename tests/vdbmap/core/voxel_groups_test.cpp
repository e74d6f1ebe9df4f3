// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel_groups.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include "tests/support/random_points.h"
#include "tests/support/sample_maps.h"

namespace vdbmap {
namespace {

// Joins, pair by pair, until nothing changes.
std::set<VoxelGroup> groups_by_brute_force(const std::vector<VoxelIndex>& voxels,
                                           const std::vector<std::uint8_t>& is_member, int reach) {
  std::vector<std::size_t> group(voxels.size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  for (bool has_changed = true; has_changed;) {
    has_changed = false;
    for (std::size_t i = 0; i < voxels.size(); ++i) {
      for (std::size_t j = 0; j < voxels.size(); ++j) {
        const VoxelIndex away = voxels[i] - voxels[j];
        const bool are_near = std::max({std::abs(away.x()), std::abs(away.y()), std::abs(away.z())}) <= reach;
        if (is_member[i] == 0 || is_member[j] == 0 || !are_near || group[i] <= group[j]) continue;
        group[i] = group[j];
        has_changed = true;
      }
    }
  }
  std::set<VoxelGroup> result;
  for (std::size_t g = 0; g < voxels.size(); ++g) {
    VoxelGroup members;
    for (std::size_t i = 0; i < voxels.size(); ++i) {
      if (is_member[i] != 0 && group[i] == g) members.push_back(i);
    }
    if (!members.empty()) result.insert(members);
  }
  return result;
}

TEST(VoxelGroups, AreThoseOfBruteForce) {
  const VoxelMap map = test::map_of_voxels(test::random_voxels(250, -20, 20, 8));
  const VoxelLevel& level = map.finest();
  std::vector<VoxelIndex> voxels;
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t) { voxels.push_back(voxel); });
  std::vector<std::uint8_t> is_member(voxels.size());
  for (std::size_t i = 0; i < voxels.size(); ++i) is_member[i] = i % 4 != 0 ? 1 : 0;
  for (const int reach : {1, 3, 5}) {
    const std::vector<VoxelGroup> groups = find_groups(level, is_member, reach);
    EXPECT_EQ(std::set<VoxelGroup>(groups.begin(), groups.end()), groups_by_brute_force(voxels, is_member, reach));
    EXPECT_TRUE(std::ranges::is_sorted(groups, {}, [](const VoxelGroup& group) { return group.front(); }));
  }
}

}  // namespace
}  // namespace vdbmap
