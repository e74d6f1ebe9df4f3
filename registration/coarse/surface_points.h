// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "vdbmap/core/voxel_level.h"

namespace vdbmap::registration {

/// One oriented point a voxel of a level: where features are computed and matched. Number i is the i-th record.
struct SurfacePoints {
  std::vector<Eigen::Vector3d> positions;  ///< [m, local frame] mean of the voxel
  std::vector<Eigen::Vector3d> normals;    ///< unit, on the side of most of the surroundings
  std::vector<double> planarities;         ///< of the voxel's own covariance, 0 to 1

  std::size_t size() const { return positions.size(); }
};

/// Points with the normals that the voxels' own covariances give, on whichever side. The same bit for bit for a voxel
/// in whatever level.
SurfacePoints fitted_points(const VoxelLevel& level);

/// Normals from the voxels' own covariances (Mortazavi 2023, section 2.3), each turned to the side on which most voxels
/// within `radius` [m] lie: streets are seen from outside, so what stands before a wall tells its outside from its
/// inside whatever way the axes point.
SurfacePoints surface_points(const VoxelLevel& level, double radius);

}  // namespace vdbmap::registration
