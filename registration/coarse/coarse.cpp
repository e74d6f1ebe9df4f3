// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/coarse/coarse.h"

#include <algorithm>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include "registration/coarse/feature_matches.h"
#include "vdbmap/core/option_check.h"

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

void check_reach(double radius, const VoxelLevel& level, const char* name) {
  if (radius > 0 && radius <= kMaxReach * level.voxel_size()) return;
  std::ostringstream message;
  message << name << " is " << radius << ", expected more than 0 up to " << kMaxReach << " voxels of "
          << level.voxel_size() << " m";
  throw std::invalid_argument(message.str());
}

}  // namespace

void CoarseOptions::check() const {
  require(feature_radius > 0, "feature_radius", feature_radius, "more than 0 m");
  require(orientation_radius > 0, "orientation_radius", orientation_radius, "more than 0 m");
  require(num_keypoints > 0, "num_keypoints", static_cast<double>(num_keypoints), "1 or more");
  require(map_share > 0 && map_share <= 1, "map_share", map_share, "more than 0 up to 1");
  require(num_nearest > 0, "num_nearest", num_nearest, "1 or more");
  consensus.check();
}

CoarseMap prepare_coarse_map(const VoxelLevel& level, const CoarseOptions& options) {
  constexpr std::size_t kMinChosen = 4000;  // a small map is matched as a whole
  options.check();
  check_reach(options.feature_radius, level, "feature_radius");
  check_reach(options.orientation_radius, level, "orientation_radius");

  CoarseMap map;
  map.points = surface_points(level, options.orientation_radius);
  map.features = fpfh_features(level, map.points, options.feature_radius);
  const auto count = static_cast<float>(std::max<std::size_t>(level.size(), 1));
  map.mean = map.features.rowwise().sum() / count;
  map.deviation = ((map.features.colwise() - map.mean).array().square().rowwise().sum() / count).sqrt();
  const auto share = static_cast<std::size_t>(options.map_share * static_cast<double>(level.size()));
  map.chosen = most_distinctive(map.features, map.mean, map.deviation, std::max(kMinChosen, share));
  return map;
}

std::vector<PoseHypothesis> find_coarse(const VoxelLevel& combined, const CoarseMap& map,
                                        const CoarseOptions& options) {
  options.check();
  const SurfacePoints points = surface_points(combined, options.orientation_radius);
  const FpfhMatrix features = fpfh_features(combined, points, options.feature_radius);
  const std::vector<std::uint32_t> keypoints =
      most_distinctive(features, map.mean, map.deviation, options.num_keypoints);
  const std::vector<FeatureMatch> matches =
      match_features(features, keypoints, map.features, map.chosen, options.num_nearest);
  return find_consensus(points, map.points, matches, options.consensus);
}

}  // namespace vdbmap::registration
