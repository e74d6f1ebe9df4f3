// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "vdbmap/change/ray_evidence.h"
#include "vdbmap/core/posed_cloud.h"
#include "vdbmap/core/visibility.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap {

/// How a map is brought up to date.
struct UpdateOptions {
  std::optional<std::int32_t> epoch;  ///< of the drive; stored in the voxels that it saw
  RayTrust trust;

  std::uint32_t min_passes = 3;  ///< rays through a voxel of the map for it to be gone
  double gone_share = 0.5;       ///< of all rays that went through or ended in a voxel of the map, for it to be gone
  double moved_share = 0.5;      ///< the same of a voxel of the drive itself, which then held something that moved

  /// Throws std::invalid_argument naming the value and what is allowed.
  void check() const;
};

/// What became of voxels of the finest level.
struct UpdateCounts {
  std::size_t added = 0;             ///< new in the map
  std::size_t confirmed = 0;         ///< of the map, seen again: points were added
  std::size_t replaced = 0;          ///< of the map, where the drive saw something else
  std::size_t gone = 0;              ///< of the map, seen through
  std::size_t unseen = 0;            ///< of the map, as they were
  std::size_t moved = 0;             ///< of the drive, left out: something was there for a while only
  std::size_t num_points = 0;        ///< of the drive
  std::size_t num_moved_points = 0;  ///< in voxels left out
};

struct UpdatedMap {
  VoxelMap map;
  Visibility visibility;
  UpdateCounts counts;
};

/// The map after a drive: points that stayed where they were during the drive are added, voxels that its rays went
/// through are gone, those that nobody looked at stay (two time scales, as ELite: Gil et al. 2025). A voxel where the
/// drive saw something else holds that alone. Without `before`, what the map's own rays said is not known.
///
/// Clouds are gone through twice. The result does not depend on their order, nor on how they are cut, nor on the number
/// of threads. Throws std::invalid_argument for bad options and a visibility of another map, std::out_of_range as
/// MapBuilder::add().
UpdatedMap update_map(const VoxelMap& map, const std::optional<Visibility>& before, const CloudSource& clouds,
                      const UpdateOptions& options = {});

/// Which voxels of a drive held something that moved while it lasted: one a record of the drive's finest level.
std::vector<std::uint8_t> find_moved(const VoxelMap& drive, const std::vector<std::uint32_t>& passes,
                                     const UpdateOptions& options);

}  // namespace vdbmap
