// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/batch_search.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include <Eigen/Eigenvalues>

#include "registration/percent.h"
#include "vdbmap/core/parallel.h"

namespace vdbmap::registration {
namespace {

// Of the hypotheses, the most that are aligned: the true one has been the first or second on every street tried.
constexpr std::size_t kMaxAligned = 6;
constexpr std::size_t kMaxAlignedFinely = 2;  // the best and its rival

void sort_by_agreement(std::vector<BatchCandidate>& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const BatchCandidate& a, const BatchCandidate& b) { return a.agreement > b.agreement; });
}

BatchCandidate align_coarsely(const CombinedScans& combined, const VoxelMap& map, const PoseHypothesis& hypothesis) {
  BatchCandidate candidate;
  candidate.coarse_guess = hypothesis.target_from_source;
  candidate.coarse_guess.translation() += map.frame.anchor;
  candidate.map_from_batch = align_coarsely(combined.sample, map, candidate.coarse_guess);
  candidate.num_feature_inliers = hypothesis.num_inliers;
  candidate.agreement = surface_agreement(combined.pieces, map, candidate.map_from_batch);
  return candidate;
}

std::vector<BatchCandidate> align_all_coarsely(const CombinedScans& combined, const VoxelMap& map,
                                               std::span<const PoseHypothesis> hypotheses) {
  std::vector<BatchCandidate> candidates(std::min(hypotheses.size(), kMaxAligned));
  parallel_for(candidates.size(), [&](std::size_t i) { candidates[i] = align_coarsely(combined, map, hypotheses[i]); });
  sort_by_agreement(candidates);
  return candidates;
}

void align_finely(BatchCandidate& candidate, const CombinedScans& combined, const VoxelMap& map) {
  FineOptions options;
  options.search_headings = false;
  const FineResult fine = align_sample(combined.sample, map, candidate.map_from_batch, options);
  candidate.map_from_batch = fine.map_from_scan;
  candidate.covariance = fine.covariance;
  candidate.agreement = surface_agreement(combined.pieces, map, fine.map_from_scan);
  candidate.evidence = weigh(combined.sample.fine, combined.rays, map, fine.map_from_scan);
}

// The best few on all levels; the others are worse by more than that can change.
void align_best_finely(std::vector<BatchCandidate>& candidates, const CombinedScans& combined, const VoxelMap& map) {
  candidates.resize(std::min(candidates.size(), kMaxAlignedFinely));
  parallel_for(candidates.size(), [&](std::size_t i) { align_finely(candidates[i], combined, map); });
  sort_by_agreement(candidates);
}

Eigen::Vector3d center_of(std::span<const Eigen::Vector3d> points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) sum += point;
  return points.empty() ? sum : Eigen::Vector3d(sum / static_cast<double>(points.size()));
}

// Of candidates that came to the same place only the best stays, with the best supported of the guesses that led there.
std::vector<BatchCandidate> without_repetitions(std::vector<BatchCandidate> candidates, const Eigen::Vector3d& center) {
  std::vector<BatchCandidate> distinct;
  for (BatchCandidate& candidate : candidates) {
    const auto known = std::find_if(distinct.begin(), distinct.end(), [&](const BatchCandidate& other) {
      return are_alike(other.map_from_batch, candidate.map_from_batch, center);
    });
    if (known == distinct.end()) {
      distinct.push_back(std::move(candidate));
    } else if (candidate.num_feature_inliers > known->num_feature_inliers) {
      known->num_feature_inliers = candidate.num_feature_inliers;
      known->coarse_guess = candidate.coarse_guess;
    }
  }
  return distinct;
}

// Standard deviation of the place in its least certain direction [m].
double greatest_deviation(const Matrix6d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance.bottomRightCorner<3, 3>().eval(),
                                                              Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(solver.eigenvalues()[2], 0.0));
}

// Why the best candidate is not believed; empty when it is.
std::string reason_not_found(std::span<const BatchCandidate> candidates, const VerdictOptions& verdict) {
  if (candidates.empty()) return "no features agree with the map";
  const BatchCandidate& best = candidates.front();
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
  if (candidates.size() < 2) return "";
  const double next = candidates[1].agreement;
  if (best.agreement >= verdict.min_margin * next) return "";
  return "another pose agrees nearly as well: " + percent(next) + " of its surfaces beside " + percent(best.agreement);
}

}  // namespace

void VerdictOptions::check() const {
  const auto require = [](bool condition, const char* name, double value, const char* allowed) {
    if (condition) return;
    std::ostringstream message;
    message << name << " is " << value << ", expected " << allowed;
    throw std::invalid_argument(message.str());
  };
  require(min_overlap >= 0 && min_overlap <= 1, "min_overlap", min_overlap, "0 to 1");
  require(min_agreement >= 0 && min_agreement <= 1, "min_agreement", min_agreement, "0 to 1");
  require(max_blocked_share >= 0 && max_blocked_share <= 1, "max_blocked_share", max_blocked_share, "0 to 1");
  require(max_deviation > 0, "max_deviation", max_deviation, "more than 0 m");
  require(min_margin >= 1, "min_margin", min_margin, "1 or more");
}

BatchResult find_batch(const CombinedScans& combined, const VoxelMap& map, const CoarseMap& coarse_map,
                       const CoarseOptions& coarse, const VerdictOptions& verdict) {
  verdict.check();
  BatchResult result;
  if (combined.sample.fine.size() < verdict.min_points) {
    result.reason = "too few points: " + std::to_string(combined.sample.fine.size()) + " of " +
                    std::to_string(verdict.min_points) + " needed, 1.5 m apart";
    return result;
  }
  const std::vector<PoseHypothesis> hypotheses = find_coarse(combined.level, coarse_map, coarse);
  const Eigen::Vector3d center = center_of(combined.sample.fine);
  result.candidates = without_repetitions(align_all_coarsely(combined, map, hypotheses), center);
  align_best_finely(result.candidates, combined, map);
  result.candidates = without_repetitions(std::move(result.candidates), center);
  result.reason = reason_not_found(result.candidates, verdict);
  return result;
}

}  // namespace vdbmap::registration
