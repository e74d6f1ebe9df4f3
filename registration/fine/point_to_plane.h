// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "registration/fine/observability.h"
#include "registration/fine/plane_residual.h"
#include "registration/fine/scan_sample.h"
#include "vdbmap/core/point_cloud.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap::registration {

/// A point this near to a plane of the finest level lies on the map [m].
inline constexpr double kInlierDistance = 0.15;

/// How a scan is aligned.
struct FineOptions {
  double coarse_spacing = 1.5;  ///< [m] of the points used on the coarser levels
  double fine_spacing = 1.0;    ///< [m] of the points used on the finest level; 0.5 m is no better on KITTI streets
  RangeLimits range;
  int max_iterations = 15;      ///< rounds of matching and solving on each level, at most 10 of them on coarser ones
  bool search_headings = true;  ///< other headings are tried where few points fit; not needed within 1 m and 3 degrees

  /// Throws std::invalid_argument naming the value and what is allowed.
  void check() const;
};

/// Where a scan lies in a map, and how well that is known.
struct FineResult {
  Eigen::Isometry3d map_from_scan = Eigen::Isometry3d::Identity();  ///< original system
  Matrix6d covariance = Matrix6d::Zero();  ///< rotation [rad^2] about the sensor, then translation [m^2]; axes of the
                                           ///< map; noise of scan and map
  double inlier_share = 0;                 ///< of the sampled points: matched within 0.15 m of a plane
  double rms_distance = 0;                 ///< [m] of the inliers from their planes
  std::size_t num_points = 0;              ///< sampled points
  bool converged = false;                  ///< the last round's step was less than 1 mm and 0.01 degrees
  std::vector<UnobservableDirection> unobservable;
};

/// Point-to-plane alignment of one scan against the map's own grids, from the coarsest level to the finest, from a
/// guess up to 2 m and 10 degrees off (Mortazavi 2023, section 2.4: fine registration). Ceres solves each round. The
/// result is the same for any number of threads. Throws std::invalid_argument for a guess that is not finite or not a
/// rotation.
FineResult align_sample(const SampledScan& sample, const VoxelMap& map, const Eigen::Isometry3d& map_from_scan_guess,
                        const FineOptions& options = {});

/// Aligns on the coarser levels only, beginning with residuals of 3 m on the coarsest: for guesses of the coarse
/// search. Good to some centimetres. Throws as align_sample().
Eigen::Isometry3d align_coarsely(const SampledScan& sample, const VoxelMap& map,
                                 const Eigen::Isometry3d& map_from_scan_guess, const FineOptions& options = {});

/// As align_sample(), for all points of a scan.
FineResult align_scan(const PointCloud& scan, const VoxelMap& map, const Eigen::Isometry3d& map_from_scan_guess,
                      const FineOptions& options = {});

}  // namespace vdbmap::registration
