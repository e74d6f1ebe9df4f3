// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/change/presence.h"

#include <atomic>
#include <optional>

#include "vdbmap/core/parallel.h"
#include "vdbmap/core/point_cell.h"

namespace vdbmap {

void add_shared(TimeBins& to, TimeBins bins) {
  static_assert(sizeof(TimeBins) == sizeof(std::uint64_t));
  const std::atomic_ref shared(reinterpret_cast<std::uint64_t&>(to));
  // Most are there already; a look costs much less than a write that other threads must see.
  if ((shared.load(std::memory_order_relaxed) & bins.bits()) != bins.bits()) {
    shared.fetch_or(bins.bits(), std::memory_order_relaxed);
  }
}

std::vector<TimeBins> presence_of(const VoxelMap& drive, const CloudSource& clouds) {
  const VoxelLevel& level = drive.finest();
  std::vector<TimeBins> presence(level.size());
  clouds([&](const PosedCloud& posed) {
    Eigen::Isometry3d local_from_cloud = posed.map_from_cloud;
    local_from_cloud.translation() -= drive.frame.anchor;
    const CellFinder cells(local_from_cloud, voxels_per_metre(level.voxel_size()));
    parallel_ranges(posed.cloud.size(), 1024, [&](std::size_t begin, std::size_t end) {
      const VoxelFinder finder(level);
      for (std::size_t i = begin; i < end; ++i) {
        const std::optional<PointCell> cell = cells.find(posed.cloud.positions[i]);
        const VoxelRecord* record = cell ? finder.find(cell->voxel) : nullptr;
        if (!record) continue;
        add_shared(presence[static_cast<std::size_t>(record - level.records().data())],
                   TimeBins::at(posed.time_of_point(i)));
      }
    });
  });
  return presence;
}

}  // namespace vdbmap
