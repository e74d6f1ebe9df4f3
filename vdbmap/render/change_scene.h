// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "vdbmap/change/map_diff.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap {

/// Voxels for a picture of changes, and the kind of each: one a record.
struct ChangeScene {
  VoxelMap map;  ///< of one level
  std::vector<Change> changes;
};

/// What a map says of itself, and what a diff says of it: a level with what vanished beside what is there. Throws
/// std::invalid_argument where the diff is of maps with another anchor or voxel size.
ChangeScene scene_of_changes(const VoxelMap& later, const MapDiff& diff);

/// Of two maps the earlier or the later one.
enum class MapSide { kEarlier, kLater };

/// The voxels of one of the two maps whose leaves lie within `reach` [m] of a place [m, original system] in plan, with
/// the kinds that the diff gives to those places; what is of the other map alone is not seen.
ChangeScene scene_around(const VoxelMap& map, MapSide side, const MapDiff& diff, const Eigen::Vector3d& place,
                         double reach);

}  // namespace vdbmap
