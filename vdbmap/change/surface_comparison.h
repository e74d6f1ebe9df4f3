// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "vdbmap/core/point_sums.h"

namespace vdbmap {

/// The points of some voxels side by side as one distribution.
struct LocalSurface {
  double count = 0;                                      ///< number of points
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();        ///< [m]
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< [m^2] divisor n-1
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();     ///< of its thinnest direction, unit, either sign
  double planarity = 0;                                  ///< 0 to 1
  double thickness = 0;                                  ///< [m^2] variance along the normal

  /// Whether it is flat enough, and has points enough, for its normal to mean something.
  bool is_planar() const;
};

/// The surface of sums over at least one point; `sums` and the mean [m] have one origin.
LocalSurface surface_of(const PointSums& sums);

/// What is significant, from DiffOptions.
struct SignificanceLimits {
  SignificanceLimits(double pose_sigma, double range_sigma, double significance);

  double common_variance;  ///< [m^2] that no number of points averages out
  double sigmas;           ///< two-sided quantile of the normal distribution
  double radius;           ///< square root of that of chi squared with 3 degrees of freedom
};

/// How far two things are apart, in standard deviations of what chance and the surveys make of it.
struct Distance {
  double sigmas = 0;
  double limit = 0;                ///< from here on it is significant
  bool is_between_planes = false;  ///< both are planar and parallel

  bool is_significant() const { return sigmas > limit; }
};

/// The distance of a voxel's points from a surface in another map. `voxel` are the points of the voxel, `around` those
/// of the 3 x 3 x 3 voxels around it in its own map, `other` in the other map; all with one origin.
Distance distance_between(const LocalSurface& voxel, const LocalSurface& around, const LocalSurface& other,
                          double voxel_size, const SignificanceLimits& limits);

/// Points of one voxel, as far as their edges are asked for.
struct VoxelPoints {
  Eigen::Vector3d mean;  ///< [m]
  double count;
};

/// How far the edge of a thing lies in two maps, one of which has points in a voxel where the other has none but in one
/// beside it: what fills a share a of one voxel and b of the next has means 1 + b/2 - a/2 apart and edges 1 + b - a, in
/// voxels, so the edge moved by twice the distance of the means, less a voxel.
Distance distance_of_edges(const VoxelPoints& voxel, const VoxelPoints& beside, double voxel_size,
                           const SignificanceLimits& limits);

/// The probability that a distance is significant when it is measured again.
double confidence_of(const Distance& distance);

}  // namespace vdbmap
