// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/map_subset.h"

#include <vector>

#include "vdbmap/core/hierarchy.h"
#include "vdbmap/core/voxel_assembly.h"

namespace vdbmap {

VoxelMap keep_voxels(const VoxelMap& map, const std::function<bool(std::size_t record)>& is_kept) {
  const VoxelLevel& all = map.finest();
  VoxelAssembly assembly(all.voxel_size(), all.size());
  for_each_voxel(all, [&](const VoxelIndex& voxel, std::size_t record) {
    if (!is_kept(record)) return;
    [[maybe_unused]] const bool in_order = assembly.add(voxel, all.records()[record]);
    for_each_channel([&](const char* /*name*/, auto channel) {
      const auto& values = all.channels().*channel;
      if (!values.empty()) (assembly.channels().*channel).push_back(values[record]);
    });
  });
  VoxelMap kept{map.frame, {}, map.has_color, map.label_scheme};
  kept.levels.push_back(assembly.finish());
  std::vector<double> voxel_sizes;
  for (const VoxelLevel& level : map.levels) voxel_sizes.push_back(level.voxel_size());
  add_coarser_levels(kept, voxel_sizes);
  return kept;
}

}  // namespace vdbmap
