// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include <Eigen/Core>

#include "vdbmap/core/ray_nodes.h"
#include "vdbmap/core/ray_walk.h"
#include "vdbmap/core/voxel_level.h"

namespace vdbmap {

/// Side of a voxel: 0 to 5 for -x +x -y +y -z +z.
using VoxelFace = std::uint8_t;

/// Points out of the voxel.
Eigen::Vector3d normal_of_face(VoxelFace face);

/// Where a ray meets an occupied voxel.
struct RayHit {
  VoxelIndex voxel;
  std::size_t record;  ///< number of the voxel's record
  VoxelFace face;      ///< through which the ray enters
  double distance;     ///< along the ray, where it enters
};

/// Follows rays through a tree of bit masks: empty regions are crossed in steps of whole nodes (410 m, 13 m and 0.8 m
/// at 10 cm), only occupied leaves voxel by voxel. Keeps a reference to the leaves; for any number of threads.
class RayCaster {
 public:
  RayCaster(const VoxelTree& tree, double voxel_size);
  explicit RayCaster(const VoxelLevel& level) : RayCaster(level.tree(), level.voxel_size()) {}

  /// The first occupied voxel that the ray enters within the range. The voxel in which the range begins does not count:
  /// it is not entered.
  std::optional<RayHit> first_hit(const Ray& ray, const RayRange& range = {}) const;

  /// Whether there is one.
  bool is_blocked(const Ray& ray, const RayRange& range) const;

 private:
  RayNodes nodes_;
  double voxel_size_;  ///< [m]
};

}  // namespace vdbmap
