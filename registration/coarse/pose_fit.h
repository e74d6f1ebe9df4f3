// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "registration/cell_table.h"
#include "registration/coarse/surface_points.h"

namespace vdbmap::registration {

/// Numbers of the points of a level by their voxels.
struct VoxelNumbers {
  double voxels_per_metre = 1;
  CellTable numbers = CellTable();
};

/// Voxels of `voxel_size` [m].
VoxelNumbers number_voxels(const SurfacePoints& points, double voxel_size);

/// How well a scan lies in a map, to a metre and 30 degrees, as poses of the coarse search are: share, 0 to 1, of some
/// hundreds of its flat points that lie by a surface of the map, every direction of space counted alike. Where the map
/// has nothing, nothing fits. `voxels` are those of the map.
double pose_fit(const SurfacePoints& scan, const SurfacePoints& map, const VoxelNumbers& voxels,
                const Eigen::Isometry3d& map_from_scan);

}  // namespace vdbmap::registration
