// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "vdbmap/core/visibility.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap::test {

/// From a sensor to a point it measured [m, original system].
struct MeasuredRay {
  Eigen::Vector3d origin;
  Eigen::Vector3d end;
};

/// What rays saw around the finest level of a map, voxel by voxel along each of them, up to a voxel's edge before its
/// end. A pass counts where a ray comes within a third of the edge of what the voxel holds.
Visibility visibility_of(const VoxelMap& map, std::span<const MeasuredRay> rays);

/// Rays from one place to every point.
std::vector<MeasuredRay> rays_from(const Eigen::Vector3d& origin, std::span<const Eigen::Vector3d> ends);

}  // namespace vdbmap::test
