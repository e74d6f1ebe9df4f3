// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "vdbmap/core/voxel_level.h"

namespace vdbmap {

/// What a voxel holds, as rays meet it: a disc of its points.
struct HeldSurface {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();             ///< [m] from the voxel's corner
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();           ///< unit; zero where the points lie on no plane
  float variance = 0;                                         ///< [m^2] of the points along the normal
  Eigen::Matrix3f information = Eigen::Matrix3f::Identity();  ///< [1/m^2] inverse of their covariance

  bool has_normal() const { return normal.squaredNorm() > 0; }
};

/// The surface of a voxel from its record. The normal is that of the 3x3x3 voxels around it where these are flat, else
/// of the voxel's own points where these are many. Few points say little of their spread: their covariance is shrunk
/// towards that of a voxel filled evenly, which counts as much as three points.
HeldSurface held_surface(const VoxelRecord& record, double voxel_size);

/// Of every voxel of a level, in the order of its records.
std::vector<HeldSurface> held_surfaces(const VoxelLevel& level);

}  // namespace vdbmap
