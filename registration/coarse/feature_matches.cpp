// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/coarse/feature_matches.h"

#include <algorithm>
#include <limits>
#include <tuple>

#include "vdbmap/core/parallel.h"

namespace vdbmap::registration {
namespace {

using Numbers = std::vector<std::uint32_t>;

constexpr Eigen::Index kBlock = 64;     // source features compared at once
constexpr Eigen::Index kStripe = 1024;  // target features compared at once: a block of distances stays in the cache

FpfhMatrix columns_of(const FpfhMatrix& features, const Numbers& chosen) {
  FpfhMatrix columns(kFpfhBins, static_cast<Eigen::Index>(chosen.size()));
  for (std::size_t i = 0; i < chosen.size(); ++i) columns.col(static_cast<Eigen::Index>(i)) = features.col(chosen[i]);
  return columns;
}

struct Candidate {
  float distance = std::numeric_limits<float>::infinity();  // squared
  std::uint32_t number = 0;

  bool operator<(const Candidate& other) const {
    return std::tie(distance, number) < std::tie(other.distance, other.number);
  }
};

// Keeps the `keep` smallest of the candidates in ascending order.
void insert(std::vector<Candidate>& nearest, const Candidate& candidate, std::size_t keep) {
  if (nearest.size() == keep && !(candidate < nearest.back())) return;
  if (nearest.size() == keep) nearest.pop_back();
  nearest.insert(std::upper_bound(nearest.begin(), nearest.end(), candidate), candidate);
}

// For every column of `queries` the nearest columns of `features`: |a - b|^2 = |a|^2 + |b|^2 - 2 a . b, so that the
// work is one matrix product.
std::vector<std::vector<Candidate>> nearest_features(const FpfhMatrix& queries, const FpfhMatrix& features,
                                                     std::size_t keep) {
  const Eigen::RowVectorXf query_norms = queries.colwise().squaredNorm();
  const Eigen::VectorXf feature_norms = features.colwise().squaredNorm().transpose();
  std::vector<std::vector<Candidate>> nearest(static_cast<std::size_t>(queries.cols()));
  const auto num_blocks = static_cast<std::size_t>((queries.cols() + kBlock - 1) / kBlock);
  parallel_for(num_blocks, [&](std::size_t block) {
    const Eigen::Index first = static_cast<Eigen::Index>(block) * kBlock;
    const Eigen::Index count = std::min(kBlock, queries.cols() - first);
    Eigen::MatrixXf distances;
    for (Eigen::Index start = 0; start < features.cols(); start += kStripe) {
      const Eigen::Index length = std::min(kStripe, features.cols() - start);
      distances.noalias() = features.middleCols(start, length).transpose() * queries.middleCols(first, count);
      for (Eigen::Index i = 0; i < count; ++i) {
        std::vector<Candidate>& best = nearest[static_cast<std::size_t>(first + i)];
        auto column = distances.col(i);
        column = feature_norms.segment(start, length) - 2 * column;
        for (Eigen::Index j = 0; j < length; ++j) {
          if (best.size() == keep && column[j] + query_norms[first + i] > best.back().distance) continue;
          insert(best, {column[j] + query_norms[first + i], static_cast<std::uint32_t>(start + j)}, keep);
        }
      }
    }
  });
  return nearest;
}

}  // namespace

void sort_best_first(std::vector<FeatureMatch>& matches) {
  std::sort(matches.begin(), matches.end(), [](const FeatureMatch& a, const FeatureMatch& b) {
    return std::tie(b.mutual, a.distance, a.source, a.target) < std::tie(a.mutual, b.distance, b.source, b.target);
  });
}

std::vector<FeatureMatch> match_features(const FpfhMatrix& source, const Numbers& chosen_source,
                                         const FpfhMatrix& target, const Numbers& chosen_target, int num_nearest) {
  const FpfhMatrix sources = columns_of(source, chosen_source);
  const FpfhMatrix targets = columns_of(target, chosen_target);
  const auto forward = nearest_features(sources, targets, static_cast<std::size_t>(num_nearest));
  const auto backward = nearest_features(targets, sources, 1);

  std::vector<FeatureMatch> matches;
  for (std::size_t i = 0; i < forward.size(); ++i) {
    for (const Candidate& candidate : forward[i]) {
      const bool mutual = backward[candidate.number].front().number == i;
      matches.push_back(
          {chosen_source[i], chosen_target[candidate.number], std::sqrt(std::max(candidate.distance, 0.0f)), mutual});
    }
  }
  sort_best_first(matches);
  return matches;
}

}  // namespace vdbmap::registration
