// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel_groups.h"

#include <algorithm>
#include <utility>

namespace vdbmap {
namespace {

// Walks from a voxel to all that hang together with it.
class GroupWalker {
 public:
  GroupWalker(const VoxelLevel& level, std::vector<std::uint8_t> is_left, std::int32_t reach)
      : level_(level), finder_(level), is_left_(std::move(is_left)), reach_(reach) {}

  bool is_left(std::size_t number) const { return is_left_[number] != 0; }

  VoxelGroup group_of(const VoxelIndex& voxel, std::size_t number) {
    VoxelGroup group;
    meet(voxel, number, group);
    while (!to_visit_.empty()) {
      const VoxelIndex next = to_visit_.back();
      to_visit_.pop_back();
      finder_.for_each_around(next, reach_, [&](const VoxelIndex& near, const VoxelRecord& record) {
        const auto found = static_cast<std::size_t>(&record - level_.records().data());
        if (is_left(found)) meet(near, found, group);
      });
    }
    std::ranges::sort(group);
    return group;
  }

 private:
  void meet(const VoxelIndex& voxel, std::size_t number, VoxelGroup& group) {
    is_left_[number] = 0;
    group.push_back(number);
    to_visit_.push_back(voxel);
  }

  const VoxelLevel& level_;
  VoxelFinder finder_;
  std::vector<std::uint8_t> is_left_;
  std::int32_t reach_;
  std::vector<VoxelIndex> to_visit_;
};

}  // namespace

std::vector<VoxelGroup> find_groups(const VoxelLevel& level, const std::vector<std::uint8_t>& is_member,
                                    std::int32_t reach) {
  std::vector<VoxelGroup> groups;
  GroupWalker walker(level, is_member, reach);
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
    if (walker.is_left(number)) groups.push_back(walker.group_of(voxel, number));
  });
  return groups;
}

}  // namespace vdbmap
