// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/tile_groups.h"

#include <algorithm>
#include <numeric>

#include "vdbmap/core/voxel_groups.h"

namespace vdbmap {
namespace {

bool is_on_border(const VoxelIndex& voxel, std::int32_t per_tile) {
  const auto is_first_or_last = [&](std::int32_t i) {
    const std::int32_t place = i - floor_divide(i, per_tile) * per_tile;
    return place < kReachOfGroups || place >= per_tile - kReachOfGroups;
  };
  return is_first_or_last(voxel.x()) || is_first_or_last(voxel.y());
}

// Calls body(key) for the voxels around one that lie in other tiles.
template <typename Body>
void for_each_across(const VoxelIndex& voxel, std::int32_t per_tile, const Body& body) {
  const TileId tile = tile_of_voxel(voxel, per_tile);
  const openvdb::CoordBBox around(voxel.offsetBy(-kReachOfGroups), voxel.offsetBy(kReachOfGroups));
  for (auto near = around.begin(); near; ++near) {
    if (is_addressable(*near) && tile_of_voxel(*near, per_tile) != tile) body(key_of_voxel(*near));
  }
}

}  // namespace

void TileGroups::add(const TileId& tile, const VoxelLevel& level, const std::vector<SeenGrade>& grades) {
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::vector<std::uint32_t> group_of(level.size(), kNone);
  for (const VoxelGroup& group : find_groups(level, are_graded(grades), kReachOfGroups)) {
    const auto number = static_cast<std::uint32_t>(groups_.size());
    groups_.push_back({number, group.size(), count_sure(group, grades)});
    for (const std::size_t record : group) group_of[record] = number;
  }
  const std::int32_t per_tile = voxels_per_tile(level.voxel_size());
  std::vector<Member>& members = members_[tile];
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t record) {
    const std::uint32_t group = group_of[record];
    if (group == kNone) return;
    members.push_back({static_cast<std::uint32_t>(record), group, grades[record] == SeenGrade::kSure});
    if (!is_on_border(voxel, per_tile)) return;
    on_borders_[key_of_voxel(voxel)] = group;
    for_each_across(voxel, per_tile, [&](VoxelKey near) {
      const auto found = on_borders_.find(near);
      if (found != on_borders_.end()) unite(group, found->second);
    });
  });
}

std::vector<std::uint8_t> TileGroups::seen_through(const TileId& tile, std::size_t num_records) const {
  std::vector<std::uint8_t> result(num_records);
  const auto members = members_.find(tile);
  if (members == members_.end()) return result;
  for (const Member& member : members->second) {
    const Group& group = groups_[root_of(member.group)];
    result.at(member.record) = member.is_sure || goes_whole(group.num_sure, group.num_voxels, options_);
  }
  return result;
}

std::uint32_t TileGroups::root_of(std::uint32_t group) const {
  while (groups_[group].parent != group) group = groups_[group].parent;
  return group;
}

// The smaller one goes into the larger: chains stay short.
void TileGroups::unite(std::uint32_t a, std::uint32_t b) {
  std::uint32_t into = root_of(a), from = root_of(b);
  if (into == from) return;
  if (groups_[into].num_voxels < groups_[from].num_voxels) std::swap(into, from);
  groups_[from].parent = into;
  groups_[into].num_voxels += groups_[from].num_voxels;
  groups_[into].num_sure += groups_[from].num_sure;
}

}  // namespace vdbmap
