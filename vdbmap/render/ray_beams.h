// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "vdbmap/core/ray_caster.h"
#include "vdbmap/core/voxel_level.h"
#include "vdbmap/render/camera.h"

namespace vdbmap {

/// Tells how far all rays of a square of pixels run through empty leaves, by following one ray through the leaves and
/// their neighbours: as long as a ray is less than a leaf away from that one, the leaf it is in is a neighbour of the
/// other's.
class RayBeams {
 public:
  /// Squares of `tile_size` pixels a side.
  RayBeams(const VoxelLevel& level, const Camera& camera, int tile_size);
  RayBeams(const RayBeams&) = delete;  // caster_ looks into leaves_
  RayBeams& operator=(const RayBeams&) = delete;

  /// A distance [m] up to which no ray through the square whose upper left pixel is (left, top) meets a voxel.
  double free_distance(int left, int top) const;

 private:
  double leaf_size_;  ///< [m]
  VoxelTree leaves_;  ///< a voxel for every leaf and each of its 26 neighbours
  RayCaster caster_;
  const Camera& camera_;
  double half_tile_;  ///< [pixels]
  double reach_;      ///< [m] up to which the rays of a square stay less than a leaf apart
};

}  // namespace vdbmap
