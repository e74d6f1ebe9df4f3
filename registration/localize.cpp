// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/localize.h"

#include <stdexcept>

#include "registration/percent.h"

namespace vdbmap::registration {
namespace {

std::string reason_not_found(const FineResult& fine, const FoundCriteria& criteria) {
  if (fine.num_points == 0) return "no point lies within the range limits";
  if (fine.inlier_share < criteria.min_inlier_share) {
    return "only " + percent(fine.inlier_share) + " of the points lie on the map, expected " +
           percent(criteria.min_inlier_share);
  }
  if (!fine.converged) return "the alignment does not come to rest";
  return "";
}

}  // namespace

void FoundCriteria::check() const {
  if (min_inlier_share >= 0 && min_inlier_share <= 1) return;
  throw std::invalid_argument("min_inlier_share is " + std::to_string(min_inlier_share) + ", expected 0 to 1");
}

LocalizedScan localize_scan(const PointCloud& scan, const VoxelMap& map, const Eigen::Isometry3d& map_from_scan_guess,
                            const FineOptions& options, const FoundCriteria& criteria) {
  criteria.check();
  LocalizedScan localized{align_scan(scan, map, map_from_scan_guess, options), ""};
  localized.reason = reason_not_found(localized.fine, criteria);
  return localized;
}

void ConstantVelocity::found(const Eigen::Isometry3d& map_from_scan) {
  const Eigen::Isometry3d last_from_this =
      last_ ? Eigen::Isometry3d(last_->inverse() * map_from_scan) : Eigen::Isometry3d::Identity();
  next_ = map_from_scan * last_from_this;
  last_ = map_from_scan;
}

}  // namespace vdbmap::registration
