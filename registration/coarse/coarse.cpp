// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/coarse/coarse.h"

#include <algorithm>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "registration/coarse/feature_matches.h"
#include "registration/coarse/level_features.h"
#include "vdbmap/core/option_check.h"
#include "vdbmap/core/parallel.h"

namespace vdbmap::registration {
namespace {

constexpr int kMaxReach = 32;  // voxels; a larger radius would search for hours

// How unusual each feature is among those of the map: flat ground and walls look alike everywhere.
std::vector<float> distinctiveness(const FpfhMatrix& features, const Eigen::VectorXf& mean,
                                   const Eigen::VectorXf& deviation) {
  constexpr float kMinDeviation = 0.01f;  // a bin that is hardly ever filled says little
  const Eigen::ArrayXf scale = (deviation.array() + kMinDeviation).inverse();
  std::vector<float> values(static_cast<std::size_t>(features.cols()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = ((features.col(static_cast<Eigen::Index>(i)) - mean).array() * scale).matrix().squaredNorm();
  }
  return values;
}

std::vector<std::uint32_t> most_distinctive(const FpfhMatrix& features, const Eigen::VectorXf& mean,
                                            const Eigen::VectorXf& deviation, std::size_t count) {
  const std::vector<float> values = distinctiveness(features, mean, deviation);
  std::vector<std::uint32_t> numbers(values.size());
  std::iota(numbers.begin(), numbers.end(), 0u);
  std::stable_sort(numbers.begin(), numbers.end(), [&](auto a, auto b) { return values[a] > values[b]; });
  numbers.resize(std::min(count, numbers.size()));
  return numbers;
}

Eigen::Vector3d center_of(const SurfacePoints& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& position : points.positions) sum += position;
  return sum / static_cast<double>(std::max<std::size_t>(points.size(), 1));
}

// Those in which the scan lies best, the better first, no two alike.
std::vector<PoseHypothesis> best_fitting(std::vector<PoseHypothesis> hypotheses, const SurfacePoints& points,
                                         const CoarseMap& map, std::size_t count) {
  std::vector<double> fits(hypotheses.size());
  parallel_for(fits.size(), [&](std::size_t i) {
    fits[i] = pose_fit(points, map.points, map.voxels, hypotheses[i].target_from_source);
  });
  std::vector<std::size_t> order(fits.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return fits[a] > fits[b]; });
  const Eigen::Vector3d center = center_of(points);
  std::vector<PoseHypothesis> best;
  for (const std::size_t i : order) {
    const auto is_known = [&](const PoseHypothesis& other) {
      return are_alike(other.target_from_source, hypotheses[i].target_from_source, center);
    };
    if (best.size() < count && std::ranges::none_of(best, is_known)) best.push_back(hypotheses[i]);
  }
  return best;
}

void check_reach(double radius, const VoxelLevel& level, const char* name) {
  if (radius > 0 && radius <= kMaxReach * level.voxel_size()) return;
  std::ostringstream message;
  message << name << " is " << radius << ", expected more than 0 up to " << kMaxReach << " voxels of "
          << level.voxel_size() << " m";
  throw std::invalid_argument(message.str());
}

void check_reaches(const VoxelLevel& level, const CoarseOptions& options) {
  options.check();
  check_reach(options.feature_radius, level, "feature_radius");
  check_reach(options.orientation_radius, level, "orientation_radius");
}

FeatureReach reach_of_features(const CoarseOptions& options) {
  return {options.orientation_radius, options.feature_radius};
}

CoarseMap coarse_map_of(LevelFeatures made, double voxel_size, const CoarseOptions& options) {
  constexpr std::size_t kMinChosen = 4000;  // a small map is matched as a whole
  CoarseMap map;
  map.points = std::move(made.points);
  map.features = std::move(made.features);
  const auto count = static_cast<float>(std::max<std::size_t>(map.points.size(), 1));
  map.mean = map.features.rowwise().sum() / count;
  map.deviation = ((map.features.colwise() - map.mean).array().square().rowwise().sum() / count).sqrt();
  const auto share = static_cast<std::size_t>(options.map_share * static_cast<double>(map.points.size()));
  map.chosen = most_distinctive(map.features, map.mean, map.deviation, std::max(kMinChosen, share));
  if (map.chosen.size() > options.max_whole) {
    map.tiles = group_by_tile(map.points, map.chosen);
    map.parts = overlapping_parts(map.tiles);
    map.voxels = number_voxels(map.points, voxel_size);
  }
  return map;
}

}  // namespace

void CoarseOptions::check() const {
  require(feature_radius > 0, "feature_radius", feature_radius, "more than 0 m");
  require(orientation_radius > 0, "orientation_radius", orientation_radius, "more than 0 m");
  require(num_keypoints > 0, "num_keypoints", static_cast<double>(num_keypoints), "1 or more");
  require(map_share > 0 && map_share <= 1, "map_share", map_share, "more than 0 up to 1");
  require(num_nearest > 0, "num_nearest", num_nearest, "1 or more");
  require(max_part_matches > 0, "max_part_matches", static_cast<double>(max_part_matches), "1 or more");
  consensus.check();
}

CoarseMap prepare_coarse_map(const VoxelLevel& level, const CoarseOptions& options) {
  check_reaches(level, options);
  return coarse_map_of(features_of_level(level, reach_of_features(options)), level.voxel_size(), options);
}

CoarseMap prepare_coarse_map(const MapWindows& map, const CoarseOptions& options) {
  const VoxelLevel& level = map.overview().coarsest();
  check_reaches(level, options);
  return coarse_map_of(features_of_map(map, reach_of_features(options)), level.voxel_size(), options);
}

std::vector<PoseHypothesis> find_coarse(const VoxelLevel& combined, const CoarseMap& map,
                                        const CoarseOptions& options) {
  options.check();
  const SurfacePoints points = surface_points(combined, options.orientation_radius);
  const FpfhMatrix features = fpfh_features(combined, points, options.feature_radius);
  const std::vector<std::uint32_t> keypoints =
      most_distinctive(features, map.mean, map.deviation, options.num_keypoints);
  if (map.parts.empty()) {
    const std::vector<FeatureMatch> matches =
        match_features(features, keypoints, map.features, map.chosen, options.num_nearest);
    return find_consensus(points, map.points, matches, options.consensus);
  }

  ConsensusOptions consensus = options.consensus;
  consensus.max_matches = options.max_part_matches;
  const TileMatches matches(features, keypoints, map.features, map.tiles, options.num_nearest);
  std::vector<std::vector<PoseHypothesis>> found(map.parts.size());
  parallel_for(map.parts.size(), [&](std::size_t i) {
    found[i] = find_consensus(points, map.points, matches.of_part(map.parts[i]), consensus);
  });
  std::vector<PoseHypothesis> all;
  for (const std::vector<PoseHypothesis>& part : found) all.insert(all.end(), part.begin(), part.end());
  return best_fitting(std::move(all), points, map, consensus.max_hypotheses);
}

}  // namespace vdbmap::registration
