// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/coarse/consensus.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <tuple>

#include "vdbmap/core/nearest_rotation.h"
#include "vdbmap/core/option_check.h"
#include "vdbmap/core/parallel.h"

namespace vdbmap::registration {
namespace {

// Points and normals of all matches, side by side for the compiler to compare several at once.
struct MatchedSide {
  Eigen::Matrix3Xf points;
  Eigen::Matrix3Xf normals;
};

struct MatchedPoints {
  MatchedSide source;
  MatchedSide target;

  std::size_t size() const { return static_cast<std::size_t>(source.points.cols()); }
};

MatchedPoints gather(const SurfacePoints& source, const SurfacePoints& target, std::span<const FeatureMatch> matches) {
  const auto count = static_cast<Eigen::Index>(matches.size());
  MatchedPoints points;
  for (MatchedSide* side : {&points.source, &points.target}) {
    side->points.resize(3, count);
    side->normals.resize(3, count);
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    const FeatureMatch& match = matches[static_cast<std::size_t>(i)];
    points.source.points.col(i) = source.positions[match.source].cast<float>();
    points.source.normals.col(i) = source.normals[match.source].cast<float>();
    points.target.points.col(i) = target.positions[match.target].cast<float>();
    points.target.normals.col(i) = target.normals[match.target].cast<float>();
  }
  return points;
}

// Which matches are compatible with which: a row of bits each.
class Compatibility {
 public:
  explicit Compatibility(std::size_t size) : words_((size + 63) / 64), bits_(size * words_) {}

  std::span<std::uint64_t> row(std::size_t i) { return {bits_.data() + i * words_, words_}; }
  std::span<const std::uint64_t> row(std::size_t i) const { return {bits_.data() + i * words_, words_}; }

  std::size_t support(std::size_t i, std::size_t j) const {
    std::size_t count = 0;
    for (std::size_t w = 0; w < words_; ++w) {
      count += static_cast<std::size_t>(std::popcount(row(i)[w] & row(j)[w]));
    }
    return count;
  }

  // The matches compatible with both i and j, and these two.
  std::vector<std::size_t> supporters(std::size_t i, std::size_t j) const {
    std::vector<std::size_t> numbers = {i, j};
    for (std::size_t w = 0; w < words_; ++w) {
      for (std::uint64_t both = row(i)[w] & row(j)[w]; both != 0; both &= both - 1) {
        numbers.push_back(64 * w + static_cast<std::size_t>(std::countr_zero(both)));
      }
    }
    return numbers;
  }

 private:
  std::size_t words_;
  std::vector<std::uint64_t> bits_;
};

// A line between two oriented points: what no motion changes.
struct LineShape {
  float length;
  float cosine_first;    // with the normal at its beginning
  float cosine_second;   // with the normal at its end
  float cosine_normals;  // between the normals
};

LineShape shape_of(const MatchedSide& side, Eigen::Index i, Eigen::Index j) {
  const Eigen::Vector3f line = side.points.col(j) - side.points.col(i);
  const float length = line.norm();
  const float inverse = 1 / std::max(length, 1e-6f);
  return {length, side.normals.col(i).dot(line) * inverse, side.normals.col(j).dot(line) * inverse,
          side.normals.col(i).dot(side.normals.col(j))};
}

bool are_compatible(const MatchedPoints& points, Eigen::Index i, Eigen::Index j, const ConsensusOptions& options) {
  const LineShape a = shape_of(points.source, i, j);
  const LineShape b = shape_of(points.target, i, j);
  const auto angle = static_cast<float>(options.max_cosine_difference);
  return std::abs(a.length - b.length) <= static_cast<float>(options.max_length_difference) &&
         std::min(a.length, b.length) >= static_cast<float>(options.min_length) &&
         std::abs(a.cosine_first - b.cosine_first) <= angle && std::abs(a.cosine_second - b.cosine_second) <= angle &&
         std::abs(a.cosine_normals - b.cosine_normals) <= angle;
}

Compatibility compare_all(const MatchedPoints& points, const ConsensusOptions& options) {
  constexpr std::size_t kGrain = 16;
  Compatibility compatibility(points.size());
  parallel_for(
      points.size(),
      [&](std::size_t i) {
        const std::span<std::uint64_t> row = compatibility.row(i);
        for (std::size_t j = 0; j < points.size(); ++j) {
          if (j == i || !are_compatible(points, static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j), options)) {
            continue;
          }
          row[j / 64] |= std::uint64_t{1} << (j % 64);
        }
      },
      kGrain);
  return compatibility;
}

// The best supported edge of a match.
struct Edge {
  std::size_t support = 0;
  std::size_t first = 0;
  std::size_t second = 0;
};

std::vector<Edge> best_edges(const Compatibility& compatibility, std::size_t num_matches) {
  constexpr std::size_t kGrain = 16;
  std::vector<Edge> edges(num_matches);
  parallel_for(
      num_matches,
      [&](std::size_t i) {
        edges[i] = {0, i, i};
        const std::span<const std::uint64_t> row = compatibility.row(i);
        for (std::size_t w = 0; w < row.size(); ++w) {
          for (std::uint64_t bits = row[w]; bits != 0; bits &= bits - 1) {
            const std::size_t j = 64 * w + static_cast<std::size_t>(std::countr_zero(bits));
            const std::size_t support = compatibility.support(i, j) + 1;
            if (support > edges[i].support) edges[i] = {support, i, j};
          }
        }
      },
      kGrain);
  std::erase_if(edges, [](const Edge& edge) { return edge.support == 0; });
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(b.support, a.first, a.second) < std::tie(a.support, b.first, b.second);
  });
  return edges;
}

// Least squares over points and normals (Arun 1987); normals count as points 2 m out, about the size of a voxel's
// surroundings.
Eigen::Isometry3d fit_pose(const MatchedPoints& points, std::span<const std::size_t> numbers) {
  constexpr double kNormalLength = 2;  // [m]
  Eigen::Vector3d source_mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_mean = Eigen::Vector3d::Zero();
  for (const std::size_t number : numbers) {
    const auto i = static_cast<Eigen::Index>(number);
    source_mean += points.source.points.col(i).cast<double>();
    target_mean += points.target.points.col(i).cast<double>();
  }
  source_mean /= static_cast<double>(numbers.size());
  target_mean /= static_cast<double>(numbers.size());

  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  for (const std::size_t number : numbers) {
    const auto i = static_cast<Eigen::Index>(number);
    products += (points.target.points.col(i).cast<double>() - target_mean) *
                (points.source.points.col(i).cast<double>() - source_mean).transpose();
    products += kNormalLength * kNormalLength * points.target.normals.col(i).cast<double>() *
                points.source.normals.col(i).cast<double>().transpose();
  }
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  target_from_source.linear() = nearest_rotation(products);
  target_from_source.translation() = target_mean - target_from_source.linear() * source_mean;
  return target_from_source;
}

std::vector<std::size_t> inliers_of(const MatchedPoints& points, const Eigen::Isometry3d& target_from_source,
                                    const ConsensusOptions& options) {
  constexpr float kMinCosine = 0.7f;  // between normals: 45 degrees
  const Eigen::Isometry3f pose = target_from_source.cast<float>();
  const auto limit = static_cast<float>(options.inlier_distance * options.inlier_distance);
  std::vector<std::size_t> inliers;
  for (std::size_t number = 0; number < points.size(); ++number) {
    const auto i = static_cast<Eigen::Index>(number);
    const Eigen::Vector3f moved = pose * points.source.points.col(i);
    if ((moved - points.target.points.col(i)).squaredNorm() > limit) continue;
    const Eigen::Vector3f normal = pose.linear() * points.source.normals.col(i);
    if (normal.dot(points.target.normals.col(i)) >= kMinCosine) inliers.push_back(number);
  }
  return inliers;
}

struct Fit {
  Eigen::Isometry3d target_from_source;
  std::vector<std::size_t> inliers;
};

Fit fit_to_inliers(const MatchedPoints& points, std::vector<std::size_t> numbers, const ConsensusOptions& options) {
  constexpr int kRounds = 4;
  constexpr std::size_t kMinMatches = 3;
  Fit fit;
  for (int round = 0; round < kRounds && numbers.size() >= kMinMatches; ++round) {
    fit.target_from_source = fit_pose(points, numbers);
    fit.inliers = inliers_of(points, fit.target_from_source, options);
    if (fit.inliers == numbers) break;
    numbers = fit.inliers;
  }
  return fit;
}

std::size_t count_source_points(std::span<const FeatureMatch> matches, std::span<const std::size_t> inliers) {
  std::vector<std::uint32_t> sources;
  for (const std::size_t number : inliers) sources.push_back(matches[number].source);
  std::sort(sources.begin(), sources.end());
  return static_cast<std::size_t>(std::unique(sources.begin(), sources.end()) - sources.begin());
}

bool is_upright(const Eigen::Isometry3d& pose, double max_tilt_deg) {
  const double cosine = std::clamp(pose.linear()(2, 2), -1.0, 1.0);
  return std::acos(cosine) * 180 / std::numbers::pi <= max_tilt_deg;
}

bool is_known(std::span<const PoseHypothesis> hypotheses, const Eigen::Isometry3d& pose,
              const Eigen::Vector3d& source_center) {
  return std::any_of(hypotheses.begin(), hypotheses.end(), [&](const PoseHypothesis& known) {
    return are_alike(known.target_from_source, pose, source_center);
  });
}

}  // namespace

bool are_alike(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, const Eigen::Vector3d& source_center) {
  constexpr double kTranslation = 2;                        // [m]
  constexpr double kRotation = 5 * std::numbers::pi / 180;  // [rad]
  return (a * source_center - b * source_center).norm() < kTranslation &&
         Eigen::Quaterniond(a.linear()).angularDistance(Eigen::Quaterniond(b.linear())) < kRotation;
}

void ConsensusOptions::check() const {
  require(inlier_distance > 0, "inlier_distance", inlier_distance, "more than 0 m");
  require(max_length_difference > 0, "max_length_difference", max_length_difference, "more than 0 m");
  require(min_length >= 0, "min_length", min_length, "0 m or more");
  require(max_cosine_difference > 0, "max_cosine_difference", max_cosine_difference, "more than 0");
  require(max_matches > 0, "max_matches", static_cast<double>(max_matches), "1 or more");
  require(max_hypotheses > 0, "max_hypotheses", static_cast<double>(max_hypotheses), "1 or more");
  require(max_tilt_deg > 0 && max_tilt_deg <= 180, "max_tilt_deg", max_tilt_deg, "more than 0 up to 180 degrees");
}

std::vector<PoseHypothesis> find_consensus(const SurfacePoints& source, const SurfacePoints& target,
                                           std::span<const FeatureMatch> matches, const ConsensusOptions& options) {
  options.check();
  matches = matches.first(std::min(matches.size(), options.max_matches));
  const MatchedPoints points = gather(source, target, matches);
  const Compatibility compatibility = compare_all(points, options);

  const Eigen::Vector3d source_center = points.source.points.cast<double>().rowwise().mean();
  std::vector<PoseHypothesis> hypotheses;
  std::vector<bool> explained(matches.size(), false);
  for (const Edge& edge : best_edges(compatibility, matches.size())) {
    if (hypotheses.size() == options.max_hypotheses) break;
    if (explained[edge.first] || explained[edge.second]) continue;
    const Fit fit = fit_to_inliers(points, compatibility.supporters(edge.first, edge.second), options);
    explained[edge.first] = true;
    if (fit.inliers.empty() || !is_upright(fit.target_from_source, options.max_tilt_deg)) continue;
    for (const std::size_t number : fit.inliers) explained[number] = true;
    if (is_known(hypotheses, fit.target_from_source, source_center)) continue;
    hypotheses.push_back({fit.target_from_source, count_source_points(matches, fit.inliers)});
  }
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const PoseHypothesis& a, const PoseHypothesis& b) { return a.num_inliers > b.num_inliers; });
  return hypotheses;
}

}  // namespace vdbmap::registration
