// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "vdbmap/core/voxel_map.h"

namespace vdbmap::registration {

/// A point of the scan and the plane of the map it should lie on.
struct PlaneMatch {
  Eigen::Vector3d point;   ///< [m] in the frame of the scan
  Eigen::Vector3d mean;    ///< [m] a point of the plane near the point, local frame of the map
  Eigen::Vector3d normal;  ///< unit
  double planarity = 0;    ///< of the plane, 0 to 1
};

/// How planes are looked for.
struct MatchOptions {
  int search_voxels = 1;          ///< voxels searched on each side of the point's own: 1 means 27 cells
  double min_planarity = 0.2;     ///< planes below are not used
  bool plane_from_voxel = false;  ///< plane from the voxel's own covariance instead of the stored neighbourhood normal
};

/// For every point the plane of the voxel whose mean is nearest, where there is one that is flat enough; the order of
/// the points is kept. With a stored normal the plane goes through the mean of all points of that surface that are
/// searched, along the normal: through the voxel's own mean only where it stands alone.
std::vector<PlaneMatch> match_planes(std::span<const Eigen::Vector3d> points_in_scan, const VoxelLevel& level,
                                     const Eigen::Isometry3d& local_from_scan, const MatchOptions& options);

}  // namespace vdbmap::registration
