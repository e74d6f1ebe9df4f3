// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include <Eigen/Geometry>

#include "registration/fine/point_to_plane.h"
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
  FineResult fine;     ///< the best alignment, also where it is not believed
  std::string reason;  ///< empty when found

  bool found() const { return reason.empty(); }
};

/// Aligns a scan from a guess up to 2 m and 10 degrees off and judges the result.
LocalizedScan localize_scan(const PointCloud& scan, const VoxelMap& map, const Eigen::Isometry3d& map_from_scan_guess,
                            const FineOptions& options = {}, const FoundCriteria& criteria = {});

/// Guesses the next pose of a moving sensor: the last one, moved on by the last motion.
class ConstantVelocity {
 public:
  explicit ConstantVelocity(const Eigen::Isometry3d& map_from_first_scan) : next_(map_from_first_scan) {}

  /// The guess for the next scan.
  const Eigen::Isometry3d& guess() const { return next_; }

  /// The next scan was found here.
  void found(const Eigen::Isometry3d& map_from_scan);

  /// The next scan was not found: it is taken to lie where it was guessed.
  void lost() { found(next_); }

 private:
  std::optional<Eigen::Isometry3d> last_;
  Eigen::Isometry3d next_;
};

}  // namespace vdbmap::registration
