// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include "vdbmap/change/ray_evidence.h"
#include "vdbmap/change/seen_through.h"
#include "vdbmap/change/voxel_fates.h"
#include "vdbmap/core/posed_cloud.h"
#include "vdbmap/core/visibility.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap {

/// How a map is brought up to date.
struct UpdateOptions {
  std::optional<std::int32_t> epoch;  ///< of the drive; stored in the voxels that it saw
  RayTrust trust;

  SeenThroughOptions gone;   ///< when voxels of the map are gone
  SeenThroughOptions moved;  ///< when voxels of the drive held something that moved while it lasted

  /// Throws std::invalid_argument naming the value and what is allowed.
  void check() const;
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
/// Clouds are gone through three times. The result does not depend on their order, nor on how they are cut, nor on the
/// number of threads. Throws std::invalid_argument for bad options and a visibility of another map, std::out_of_range
/// as MapBuilder::add().
UpdatedMap update_map(const VoxelMap& map, const std::optional<Visibility>& before, const CloudSource& clouds,
                      const UpdateOptions& options = {});

}  // namespace vdbmap
