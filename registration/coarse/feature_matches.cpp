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

// The nearest of a group of sources to each target.
struct NearestSources {
  std::vector<float> distances;  // squared
  std::vector<std::uint32_t> numbers;

  explicit NearestSources(std::size_t count)
      : distances(count, std::numeric_limits<float>::infinity()), numbers(count, 0) {}

  // The source of that number has these distances from targets from `start` on. Of equally near ones the first stays.
  void take(std::uint32_t number, const float* from, std::size_t start, std::size_t count) {
    float* nearest = distances.data() + start;
    std::uint32_t* nearest_number = numbers.data() + start;
    for (std::size_t j = 0; j < count; ++j) {
      const bool is_nearer = from[j] < nearest[j];
      nearest[j] = is_nearer ? from[j] : nearest[j];
      nearest_number[j] = is_nearer ? number : nearest_number[j];
    }
  }

  // Those of sources of higher numbers.
  void take(const NearestSources& others) {
    for (std::size_t j = 0; j < distances.size(); ++j) {
      if (!(others.distances[j] < distances[j])) continue;
      distances[j] = others.distances[j];
      numbers[j] = others.numbers[j];
    }
  }
};

// Keeps the nearest of targets from `start` on, several of which are passed over at a time where none is near.
void take_nearest(std::vector<Candidate>& best, const float* distances, std::size_t start, std::size_t count,
                  std::size_t keep) {
  constexpr std::size_t kAtOnce = 16;
  for (std::size_t begin = 0; begin < count; begin += kAtOnce) {
    const std::size_t end = std::min(begin + kAtOnce, count);
    float least = distances[begin];
    for (std::size_t j = begin; j < end; ++j) least = distances[j] < least ? distances[j] : least;
    if (best.size() == keep && least > best.back().distance) continue;
    for (std::size_t j = begin; j < end; ++j) {
      if (best.size() == keep && distances[j] > best.back().distance) continue;
      insert(best, {distances[j], static_cast<std::uint32_t>(start + j)}, keep);
    }
  }
}

struct NearestOfBoth {
  std::vector<std::vector<Candidate>> targets;  // of each source, ascending
  NearestSources sources;                       // of each target
};

// |a - b|^2 = |a|^2 + |b|^2 - 2 a . b, so that the work is one matrix product, which serves both directions.
NearestOfBoth nearest_of_both(const FpfhMatrix& sources, const FpfhMatrix& targets, std::size_t keep) {
  const Eigen::RowVectorXf source_norms = sources.colwise().squaredNorm();
  const Eigen::VectorXf target_norms = targets.colwise().squaredNorm().transpose();
  const auto num_blocks = static_cast<std::size_t>((sources.cols() + kBlock - 1) / kBlock);
  NearestOfBoth nearest{std::vector<std::vector<Candidate>>(static_cast<std::size_t>(sources.cols())),
                        NearestSources(static_cast<std::size_t>(targets.cols()))};
  std::vector<NearestSources> of_block(num_blocks, NearestSources(static_cast<std::size_t>(targets.cols())));
  parallel_for(num_blocks, [&](std::size_t block) {
    const Eigen::Index first = static_cast<Eigen::Index>(block) * kBlock;
    const Eigen::Index count = std::min(kBlock, sources.cols() - first);
    Eigen::MatrixXf distances;
    for (Eigen::Index start = 0; start < targets.cols(); start += kStripe) {
      const Eigen::Index length = std::min(kStripe, targets.cols() - start);
      distances.noalias() = targets.middleCols(start, length).transpose() * sources.middleCols(first, count);
      for (Eigen::Index i = 0; i < count; ++i) {
        auto column = distances.col(i);
        column = (target_norms.segment(start, length) - 2 * column).array() + source_norms[first + i];
        const auto from = static_cast<std::size_t>(start);
        const auto number = static_cast<std::size_t>(first + i);
        take_nearest(nearest.targets[number], column.data(), from, static_cast<std::size_t>(length), keep);
        of_block[block].take(static_cast<std::uint32_t>(number), column.data(), from, static_cast<std::size_t>(length));
      }
    }
  });
  for (const NearestSources& block : of_block) nearest.sources.take(block);
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
  const NearestOfBoth nearest = nearest_of_both(sources, targets, static_cast<std::size_t>(num_nearest));

  std::vector<FeatureMatch> matches;
  for (std::size_t i = 0; i < nearest.targets.size(); ++i) {
    for (const Candidate& candidate : nearest.targets[i]) {
      const bool mutual = nearest.sources.numbers[candidate.number] == i;
      matches.push_back(
          {chosen_source[i], chosen_target[candidate.number], std::sqrt(std::max(candidate.distance, 0.0f)), mutual});
    }
  }
  sort_best_first(matches);
  return matches;
}

}  // namespace vdbmap::registration
