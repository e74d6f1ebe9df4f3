// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <Eigen/Geometry>

#include "registration/fine/point_to_plane.h"
#include "registration/fine/scan_sample.h"
#include "vdbmap/core/point_cloud.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap::registration {

/// When an aligned scan counts as found.
struct FoundCriteria {
  double min_inlier_share = 0.3;  ///< of the sampled points: matched within 0.15 m of a plane

  /// Throws std::invalid_argument naming the value and what is allowed.
  void check() const;
};

/// One scan in a map, or why it was not found there.
struct LocalizedScan {
  FineResult fine;                ///< the best alignment, also where it is not believed
  std::string reason;             ///< empty when found
  std::string time_problem = {};  ///< why it was not deskewed although it has time stamps; empty where nothing is wrong

  bool found() const { return reason.empty(); }
};

/// Aligns a scan from a guess up to 2 m and 10 degrees off and judges the result.
LocalizedScan localize_scan(const PointCloud& scan, const VoxelMap& map, const Eigen::Isometry3d& map_from_scan_guess,
                            const FineOptions& options = {}, const FoundCriteria& criteria = {});

/// The same of a scan that is thinned already.
LocalizedScan localize_sample(const SampledScan& sample, const VoxelMap& map,
                              const Eigen::Isometry3d& map_from_scan_guess, const FineOptions& options = {},
                              const FoundCriteria& criteria = {});

}  // namespace vdbmap::registration
