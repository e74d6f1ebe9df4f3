// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/localize.h"

#include <stdexcept>
#include <utility>

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

LocalizedScan judged(FineResult fine, const FoundCriteria& criteria) {
  std::string reason = reason_not_found(fine, criteria);
  return {std::move(fine), std::move(reason)};
}

}  // namespace

void FoundCriteria::check() const {
  if (min_inlier_share >= 0 && min_inlier_share <= 1) return;
  throw std::invalid_argument("min_inlier_share is " + std::to_string(min_inlier_share) + ", expected 0 to 1");
}

LocalizedScan localize_scan(const PointCloud& scan, const VoxelMap& map, const Eigen::Isometry3d& map_from_scan_guess,
                            const FineOptions& options, const FoundCriteria& criteria) {
  criteria.check();
  return judged(align_scan(scan, map, map_from_scan_guess, options), criteria);
}

LocalizedScan localize_sample(const SampledScan& sample, const VoxelMap& map,
                              const Eigen::Isometry3d& map_from_scan_guess, const FineOptions& options,
                              const FoundCriteria& criteria) {
  criteria.check();
  return judged(align_sample(sample, map, map_from_scan_guess, options), criteria);
}

}  // namespace vdbmap::registration
