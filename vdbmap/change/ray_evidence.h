// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "vdbmap/change/held_surface.h"
#include "vdbmap/change/seen_space.h"
#include "vdbmap/core/measured_ray.h"
#include "vdbmap/core/visibility.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap {

/// How far rays are believed.
struct RayTrust {
  double range_sigma = 0.02;     ///< [m] of a measured distance
  double position_sigma = 0.02;  ///< [m] of rays against the map, across the ray: poses, and the map's own errors
  double clearance = 0.15;       ///< [m] to the surface in which a ray ends: nearer to it, nothing counts as passed
  double max_range = 60;         ///< [m] from the sensor; beyond, nothing counts as passed

  /// Throws std::invalid_argument naming the value and what is allowed.
  void check() const;
};

/// What rays say of the voxels of one or two maps of a frame, on their finest level: through which they went.
///
/// A ray ends where it comes within `clearance` of the plane on which it ends: one that grazes the road runs for metres
/// through the voxels that hold the road, and a hand above it, and says nothing of them. Of an occupied voxel it says
/// something only where it goes through what the voxel holds, as a disc of points, and ends behind it by three standard
/// deviations of all that is uncertain.
///
/// Sums do not depend on the number of threads, nor on how rays are cut into calls.
class RayEvidence {
 public:
  /// Keeps references. Throws std::invalid_argument for no maps or more than two, and where their frames or voxel sizes
  /// differ.
  RayEvidence(std::vector<const VoxelMap*> maps, const RayTrust& trust = {});

  /// Counts rays [m, local frame of the maps]; those that are not finite or leave the addressable space say nothing.
  void add(std::span<const MeasuredRay> rays);

  /// For every record of the finest level of map number `map`, how many rays went through what it holds.
  const std::vector<std::uint32_t>& passes(std::size_t map) const { return sides_[map].passes; }

  /// The voxels that rays went through and that no map occupies.
  VoxelTree seen_empty() const { return space_.seen_empty(); }

 private:
  struct Side {
    const VoxelMap* map = nullptr;
    std::vector<HeldSurface> surfaces;
    std::vector<std::uint32_t> passes;
  };
  class Walker;

  RayTrust trust_;
  double voxel_size_;
  std::vector<Side> sides_;
  SeenSpace space_;
};

}  // namespace vdbmap
