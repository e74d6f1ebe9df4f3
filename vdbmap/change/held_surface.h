// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "vdbmap/core/voxel_level.h"

namespace vdbmap {

/// What a voxel holds, as rays meet it: a disc of its points.
struct HeldSurface {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();           ///< [m] from the voxel's corner
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();         ///< unit; zero where the points lie on no plane
  float variance = 0;                                       ///< [m^2] of the points along the normal
  Eigen::Matrix3f axes_from_map = Eigen::Matrix3f::Zero();  ///< rows: the principal axes of the points
  Eigen::Vector3f variances = Eigen::Vector3f::Zero();      ///< [m^2] along them

  bool has_normal() const { return normal.squaredNorm() > 0; }

  /// Squared Mahalanobis distance of a place, given from the mean, to the points that are sure to be where they seem
  /// although rays are off by `sigma` [m]: what is thinner than that is nowhere for sure.
  float distance_squared(const Eigen::Vector3f& from_mean, float sigma) const {
    constexpr float kLeast = 0.003f * 0.003f;  // [m^2]
    const Eigen::Array3f along = (axes_from_map * from_mean).array();
    return (along * along / (variances.array() - sigma * sigma).max(kLeast)).sum();
  }
};

/// The surface of a voxel from its record. The normal is that of the 3x3x3 voxels around it where these are flat, else
/// of the voxel's own points where these are many. Few points say little of their spread: their covariance is shrunk
/// towards that of a voxel filled evenly, which counts as much as three points.
HeldSurface held_surface(const VoxelRecord& record, double voxel_size);

/// Of every voxel of a level, in the order of its records.
std::vector<HeldSurface> held_surfaces(const VoxelLevel& level);

}  // namespace vdbmap
