// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/web/change_marks.h"

#include <cstdint>
#include <utility>
#include <vector>

#include "vdbmap/core/parallel.h"
#include "vdbmap/core/voxel_assembly.h"
#include "vdbmap/core/voxel_block.h"

namespace vdbmap {
namespace {

struct Mark {
  VoxelKey key;
  const VoxelRecord* record;
  Change change;
};

}  // namespace

VoxelLevel change_marks(const MapDiff& diff) {
  std::vector<Mark> marks;
  const auto add = [&](const ChangedVoxels& voxels, Change change) {
    for_each_voxel(voxels.level, [&](const VoxelIndex& voxel, std::size_t record) {
      marks.push_back({key_of_voxel(voxel), &voxels.level.records()[record], change});
    });
  };
  add(diff.appeared, Change::kAppeared);
  add(diff.vanished, Change::kVanished);
  add(diff.changed, Change::kChanged);
  const VoxelRecord nothing;
  for (const VoxelLeaf& leaf : diff.unobserved.leaves()) {
    for_each_voxel(leaf, [&](const VoxelIndex& voxel, std::size_t /*record*/) {
      marks.push_back({key_of_voxel(voxel), &nothing, Change::kUnobserved});
    });
  }
  // A voxel is of one kind at most.
  parallel_sort(marks, [](const Mark& a, const Mark& b) { return a.key < b.key; });
  VoxelAssembly assembly(diff.voxel_size(), marks.size());
  for (const Mark& mark : marks) {
    if (!assembly.add(voxel_of_key(mark.key), *mark.record)) continue;
    assembly.channels().labels.push_back(static_cast<std::int32_t>(mark.change));
  }
  return assembly.finish();
}

}  // namespace vdbmap
