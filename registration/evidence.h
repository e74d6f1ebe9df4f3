// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "vdbmap/core/measured_ray.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap::registration {

/// A flat piece of surface.
struct SurfacePiece {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();   ///< unit, either sign
};

/// The flat voxels of a level [m, its local frame].
std::vector<SurfacePiece> flat_pieces(const VoxelLevel& level);

/// Share, 0 to 1, of the pieces near the map's coarsest level that lie on a surface of it, to 0.2 m and 20 degrees,
/// every direction of space counted alike: ground fits anywhere, what stands on it only where it belongs. Depends
/// less on how densely the map was scanned than points on 10 cm planes do; of few rings in a sparse map even a true
/// pose can stay below a half.
double surface_agreement(std::span<const SurfacePiece> pieces, const VoxelMap& map,
                         const Eigen::Isometry3d& map_from_source);

/// What speaks for and against points lying in a map as a pose says.
struct Evidence {
  std::size_t num_points = 0;
  double overlap = 0;           ///< share of the points that have the map within a voxel of the coarsest level
  double on_surface_share = 0;  ///< of the overlapping points: within 0.15 m of a plane of the finest level
  std::size_t num_rays = 0;
  double blocked_share = 0;  ///< of the rays: would have had to pass through a solid surface of the map

  /// Share of all points that the map explains: one figure to compare poses by.
  double explained_share() const { return overlap * on_surface_share; }
};

/// Weighs a pose. Points, and rays that end in them, are in the frame of the source; `map_from_source` leads to the
/// original system. The same for any number of threads.
Evidence weigh(std::span<const Eigen::Vector3d> points, std::span<const MeasuredRay> rays, const VoxelMap& map,
               const Eigen::Isometry3d& map_from_source);

}  // namespace vdbmap::registration
