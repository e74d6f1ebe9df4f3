// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/batch_search.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <Eigen/Eigenvalues>

#include "registration/map_window.h"
#include "vdbmap/core/parallel_tasks.h"

namespace vdbmap::registration {
namespace {

// Places that are compared: the true one has been that of the first or second hypothesis on every street tried.
constexpr std::size_t kMaxPlaces = 6;

// Alignment on all levels makes agreement greater by at most this factor: by 1.04 on KITTI streets.
constexpr double kMaxGain = 1.3;

using Candidates = std::vector<BatchCandidate>;

// What hypotheses are aligned and compared with.
struct Search {
  const CombinedScans& combined;
  const MapWindows& map;
  const VerdictOptions& verdict;
  FineOptions fine;
  Eigen::Vector3d center;  // [m] of the batch
};

void sort_by_agreement(Candidates& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const BatchCandidate& a, const BatchCandidate& b) { return a.agreement > b.agreement; });
}

BatchCandidate align_on_coarser_levels(const PoseHypothesis& hypothesis, const Search& search) {
  BatchCandidate candidate;
  candidate.coarse_guess = hypothesis.target_from_source;
  const VoxelMap& map = search.map.overview();
  candidate.coarse_guess.translation() += map.frame.anchor;
  candidate.map_from_batch = align_coarsely(search.combined.sample, map, candidate.coarse_guess, search.fine);
  candidate.num_feature_inliers = hypothesis.num_inliers;
  candidate.agreement = surface_agreement(search.combined.pieces, map, candidate.map_from_batch);
  return candidate;
}

void align_on_all_levels(BatchCandidate& candidate, const Search& search) {
  const SampledScan& sample = search.combined.sample;
  const std::shared_ptr<const VoxelMap> map = window_of(search.map, sample.fine, candidate.map_from_batch);
  const FineResult fine = align_sample(sample, *map, candidate.map_from_batch, search.fine);
  candidate.map_from_batch = fine.map_from_scan;
  candidate.covariance = fine.covariance;
  candidate.agreement = surface_agreement(search.combined.pieces, *map, fine.map_from_scan);
  candidate.evidence = weigh(sample.fine, search.combined.rays, *map, fine.map_from_scan);
}

Eigen::Vector3d center_of(std::span<const Eigen::Vector3d> points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) sum += point;
  return points.empty() ? sum : Eigen::Vector3d(sum / static_cast<double>(points.size()));
}

// The better first. Of candidates that came to the same place only the best stays, with the best supported of the
// guesses that led there.
Candidates distinct_places(Candidates candidates, const Eigen::Vector3d& center) {
  sort_by_agreement(candidates);
  Candidates distinct;
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

// Whether a hypothesis is aligned though some before it came to one place: until there is a rival, then where about as
// many features speak for it as for the first, as they do where places look alike.
bool is_worth_a_try(const PoseHypothesis& hypothesis, const PoseHypothesis& first, std::size_t num_places) {
  constexpr std::size_t kBestAndRival = 2;
  return num_places < kBestAndRival || 2 * hypothesis.num_inliers >= first.num_inliers;
}

// Where the hypotheses lead on the coarser levels. Those that meet leave room for the next.
Candidates places_of(std::span<const PoseHypothesis> hypotheses, const Search& search) {
  Candidates places;
  for (std::size_t begin = 0; begin < hypotheses.size() && places.size() < kMaxPlaces;) {
    const std::size_t count = std::min(hypotheses.size() - begin, kMaxPlaces - places.size());
    if (begin > 0 && !is_worth_a_try(hypotheses[begin], hypotheses[0], places.size())) break;
    Candidates aligned(count);
    parallel_tasks(count, [&](std::size_t i) { aligned[i] = align_on_coarser_levels(hypotheses[begin + i], search); });
    places.insert(places.end(), aligned.begin(), aligned.end());
    places = distinct_places(std::move(places), search.center);
    begin += count;
  }
  return places;
}

// How many of the waiting places are aligned on all levels next: until there is a rival to the best, then those that
// may yet come as near to it as to put it in doubt, where nothing else does.
std::size_t count_next(std::span<const BatchCandidate> aligned, std::span<const BatchCandidate> waiting,
                       const VerdictOptions& verdict) {
  constexpr std::size_t kBestAndRival = 2;
  if (aligned.size() < kBestAndRival) return std::min(waiting.size(), kBestAndRival - aligned.size());
  if (!reason_not_found(aligned, verdict).empty()) return 0;
  const double least = aligned.front().agreement / (verdict.min_margin * kMaxGain);
  const auto end = std::find_if(waiting.begin(), waiting.end(),
                                [&](const BatchCandidate& candidate) { return candidate.agreement < least; });
  return static_cast<std::size_t>(end - waiting.begin());
}

// Of places in the order of their agreement those that matter, aligned on all levels.
Candidates align_contenders(Candidates places, const Search& search) {
  Candidates contenders;
  std::size_t num_aligned = 0;
  while (true) {
    const std::span<BatchCandidate> waiting = std::span(places).subspan(num_aligned);
    const std::size_t count = count_next(contenders, waiting, search.verdict);
    if (count == 0) return contenders;
    parallel_tasks(count, [&](std::size_t i) { align_on_all_levels(waiting[i], search); });
    contenders.insert(contenders.end(), waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(count));
    contenders = distinct_places(std::move(contenders), search.center);
    num_aligned += count;
  }
}

}  // namespace

BatchResult find_batch(const CombinedScans& combined, const MapWindows& map, const CoarseMap& coarse_map,
                       const CoarseOptions& coarse, const VerdictOptions& verdict, const FineOptions& fine) {
  verdict.check();
  fine.check();
  if (reason_too_few(combined.sample.fine.size(), verdict).empty()) {
    return compare_hypotheses(combined, map, find_coarse(combined.level, coarse_map, coarse), verdict, fine);
  }
  BatchResult result;
  result.reason = reason_too_few(combined.sample.fine.size(), verdict);
  return result;
}

BatchResult compare_hypotheses(const CombinedScans& combined, const MapWindows& map,
                               std::span<const PoseHypothesis> hypotheses, const VerdictOptions& verdict,
                               const FineOptions& fine) {
  verdict.check();
  fine.check();
  Search search{combined, map, verdict, fine, center_of(combined.sample.fine)};
  search.fine.search_headings = false;
  BatchResult result;
  result.candidates = align_contenders(places_of(hypotheses, search), search);
  result.reason = reason_not_found(result.candidates, verdict);
  return result;
}

}  // namespace vdbmap::registration
