// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/web/marked_level.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "vdbmap/change/map_diff.h"
#include "vdbmap/core/hierarchy.h"
#include "vdbmap/core/voxel_assembly.h"
#include "vdbmap/core/voxel_block.h"

namespace vdbmap {
namespace {

constexpr std::uint32_t kNotThere = std::numeric_limits<std::uint32_t>::max();

// A voxel of the level, of the diff or of both, and its records there.
struct MarkedVoxel {
  VoxelKey key;
  std::uint32_t in_level = kNotThere;
  std::uint32_t in_marks = kNotThere;
};

std::vector<MarkedVoxel> voxels_of_both(const VoxelLevel& level, const VoxelLevel& marks) {
  std::vector<MarkedVoxel> voxels;
  voxels.reserve(level.size() + marks.size());
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
    voxels.push_back({key_of_voxel(voxel), static_cast<std::uint32_t>(number), kNotThere});
  });
  for_each_voxel(marks, [&](const VoxelIndex& voxel, std::size_t number) {
    voxels.push_back({key_of_voxel(voxel), kNotThere, static_cast<std::uint32_t>(number)});
  });
  std::ranges::stable_sort(voxels, {}, &MarkedVoxel::key);
  // Of two, the level's comes first.
  std::size_t kept = 0;
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    if (kept > 0 && voxels[kept - 1].key == voxels[i].key) {
      voxels[kept - 1].in_marks = voxels[i].in_marks;
    } else {
      voxels[kept++] = voxels[i];
    }
  }
  voxels.resize(kept);
  return voxels;
}

template <typename Values>
void push_value(const Values& from, std::uint32_t number, Values& to) {
  if (!from.empty()) to.push_back(number == kNotThere ? typename Values::value_type() : from[number]);
}

}  // namespace

MarkedLevel MarkedLevel::coarsened() const {
  const auto parents_of = [](const VoxelLevel& level) { return coarsen(level, 2, 2 * level.voxel_size()); };
  return {parents_of(voxels), marks ? std::optional(parents_of(*marks)) : std::nullopt};
}

MarkedLevel with_marks(const VoxelLevel& level, const VoxelLevel& marks, const VoxelLevel* before) {
  const std::vector<MarkedVoxel> list = voxels_of_both(level, marks);
  std::optional<VoxelFinder> finder;
  if (before) finder.emplace(*before);
  VoxelAssembly voxels(level.voxel_size(), list.size()), marked(level.voxel_size(), list.size());
  for (const MarkedVoxel& voxel : list) {
    const std::int32_t mark = voxel.in_marks == kNotThere ? kNoLabel : marks.channels().labels[voxel.in_marks];
    const VoxelIndex index = voxel_of_key(voxel.key);
    const VoxelRecord* record = nullptr;
    std::int32_t label = kNoLabel;
    if (voxel.in_level != kNotThere) {
      record = &level.records()[voxel.in_level];
      if (!level.channels().labels.empty()) label = level.channels().labels[voxel.in_level];
    } else if (static_cast<Change>(mark) == Change::kVanished) {
      record = finder ? finder->find(index) : nullptr;
      if (record && !before->channels().labels.empty()) {
        label = before->channels().labels[static_cast<std::size_t>(record - before->records().data())];
      }
      if (!record) record = &marks.records()[voxel.in_marks];
    }
    if (!record || record->count == 0 || !voxels.add(index, *record) || !marked.add(index, *record)) continue;
    if (!level.channels().labels.empty()) voxels.channels().labels.push_back(label);
    push_value(level.channels().intensities, voxel.in_level, voxels.channels().intensities);
    push_value(level.channels().first_epochs, voxel.in_level, voxels.channels().first_epochs);
    push_value(level.channels().last_epochs, voxel.in_level, voxels.channels().last_epochs);
    marked.channels().labels.push_back(mark);
  }
  return {voxels.finish(), marked.finish()};
}

}  // namespace vdbmap
