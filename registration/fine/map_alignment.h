// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>

#include "registration/rigid_motion.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap::registration {

/// How one survey lies against another of the same place.
struct MapAlignment {
  Eigen::Isometry3d earlier_from_later = Eigen::Isometry3d::Identity();  ///< original system
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< [m] of the later map's middle, by that motion
  double turn_deg = 0;                              ///< angle of that motion
  double inlier_share = 0;     ///< of the later map's sampled voxels: within 0.15 m of a plane of the earlier one
  std::size_t num_points = 0;  ///< sampled voxels
};

/// Aligns the later of two maps with the earlier one by the means of its finest voxels, point to plane, from where it
/// lies: up to some decimetres (fine/point_to_plane.h). What changed counts little, as residuals are weighted robustly.
/// Throws std::invalid_argument where a map has no voxels, or too few planes meet to say how they lie.
MapAlignment align_maps(const VoxelMap& earlier, const VoxelMap& later);

}  // namespace vdbmap::registration
