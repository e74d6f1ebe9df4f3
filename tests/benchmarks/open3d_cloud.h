// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <open3d/geometry/PointCloud.h>

#include "vdbmap/core/point_cloud.h"
#include "vdbmap/core/voxel_level.h"

namespace vdbmap::benchmarks {

/// The same points and colours for the peer.
open3d::geometry::PointCloud open3d_cloud(const PointCloud& cloud);

/// Means and normals of all voxels of a level [m, local frame].
open3d::geometry::PointCloud open3d_cloud(const VoxelLevel& level);

}  // namespace vdbmap::benchmarks
