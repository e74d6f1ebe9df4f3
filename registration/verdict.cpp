// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/verdict.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "registration/percent.h"
#include "vdbmap/core/option_check.h"

namespace vdbmap::registration {
namespace {

// Standard deviation of the place in its least certain direction [m].
double greatest_deviation(const Matrix6d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance.bottomRightCorner<3, 3>().eval(),
                                                              Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(solver.eigenvalues()[2], 0.0));
}

// Why a candidate is not believed, whatever the others; empty when it is.
std::string reason_against(const BatchCandidate& best, const VerdictOptions& verdict) {
  if (best.evidence.overlap < verdict.min_overlap) {
    return "only " + percent(best.evidence.overlap) + " of the points have the map near by";
  }
  if (best.agreement < verdict.min_agreement) {
    return "only " + percent(best.agreement) + " of its surfaces agree with the map's";
  }
  if (best.evidence.blocked_share > verdict.max_blocked_share) {
    return percent(best.evidence.blocked_share) + " of the rays would pass through solid map";
  }
  if (greatest_deviation(best.covariance) > verdict.max_deviation) return "the map does not determine its place";
  return "";
}

}  // namespace

void VerdictOptions::check() const {
  require(min_overlap >= 0 && min_overlap <= 1, "min_overlap", min_overlap, "0 to 1");
  require(min_agreement >= 0 && min_agreement <= 1, "min_agreement", min_agreement, "0 to 1");
  require(max_blocked_share >= 0 && max_blocked_share <= 1, "max_blocked_share", max_blocked_share, "0 to 1");
  require(max_deviation > 0, "max_deviation", max_deviation, "more than 0 m");
  require(min_margin >= 1, "min_margin", min_margin, "1 or more");
}

std::string reason_too_few(std::size_t num_points, const VerdictOptions& verdict) {
  if (num_points >= verdict.min_points) return "";
  return "too few points: " + std::to_string(num_points) + " of " + std::to_string(verdict.min_points) +
         " needed, 1.5 m apart";
}

std::string reason_not_found(std::span<const BatchCandidate> candidates, const VerdictOptions& verdict) {
  if (candidates.empty()) return "no features agree with the map";
  const BatchCandidate& best = candidates.front();
  std::string reason = reason_against(best, verdict);
  if (!reason.empty() || candidates.size() < 2) return reason;
  const double next = candidates[1].agreement;
  if (best.agreement >= verdict.min_margin * next) return "";
  return "another pose agrees nearly as well: " + percent(next) + " of its surfaces beside " + percent(best.agreement);
}

}  // namespace vdbmap::registration
