// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "registration/coarse/surface_points.h"
#include "vdbmap/core/voxel_level.h"

namespace vdbmap::registration {

inline constexpr int kBinsPerAngle = 11;
inline constexpr int kFpfhBins = 3 * kBinsPerAngle;

/// One feature a column: three histograms of 11 bins, each of sum 1, or all 0 for a point without neighbours.
using FpfhMatrix = Eigen::Matrix<float, kFpfhBins, Eigen::Dynamic>;

/// The three angles between two oriented points (Mortazavi 2023, eq. 3; Rusu 2009): with u the normal of the point
/// whose normal makes the smaller angle with the line between them, v = (line x u) / |line x u| and w = u x v.
struct PairAngles {
  double alpha = 0;  ///< v . n, -1 to 1
  double phi = 0;    ///< u . line, -1 to 1
  double theta = 0;  ///< [rad] atan2(w . n, u . n)
};
PairAngles pair_angles(const Eigen::Vector3d& point_a, const Eigen::Vector3d& normal_a, const Eigen::Vector3d& point_b,
                       const Eigen::Vector3d& normal_b);

/// Fast point feature histograms of all voxels of a level (Mortazavi 2023, eq. 4; Rusu 2009): that of a point alone and
/// those of its neighbours within `radius` [m], weighted by the inverse of their distance. The same
/// for any number of threads.
FpfhMatrix fpfh_features(const VoxelLevel& level, const SurfacePoints& points, double radius);

}  // namespace vdbmap::registration
