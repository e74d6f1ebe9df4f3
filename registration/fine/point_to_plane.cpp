// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/fine/point_to_plane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "registration/fine/observability.h"
#include "registration/fine/robust_rounds.h"
#include "vdbmap/core/option_check.h"

namespace vdbmap::registration {
namespace {

// Below this share of inliers other headings are tried. On KITTI streets aligned scans keep above 0.6, lost ones below
// 0.4.
constexpr double kTrustedInlierShare = 0.5;

// Headings tried around the guess; each catches 3 degrees on either side.
constexpr std::array kHeadings_deg = {0.0, -5.0, 5.0, -10.0, 10.0};

// Stages from wide to narrow: kernels start at the distance the stage has to bridge and shrink to the level's noise.
MatchingStage near_stage(const VoxelLevel& level, std::span<const Eigen::Vector3d> points) {
  return {&level, points, {.search_voxels = 2, .min_planarity = 0.5, .plane_from_voxel = true}, {3.0, 3.0, 1.0}, 10};
}

MatchingStage wide_stage(const VoxelLevel& level, std::span<const Eigen::Vector3d> points) {
  return {&level, points, {.search_voxels = 2, .min_planarity = 0.5, .plane_from_voxel = true}, {3.0, 0.2, 0.8}, 20};
}

MatchingStage coarse_stage(const VoxelLevel& level, std::span<const Eigen::Vector3d> points, int max_iterations) {
  return {&level,
          points,
          {.search_voxels = 1, .min_planarity = 0.3, .plane_from_voxel = true},
          {1.0, 0.2, 0.6},
          std::min(10, max_iterations)};
}

MatchingStage middle_stage(const VoxelLevel& level, std::span<const Eigen::Vector3d> points) {
  return {&level, points, {.search_voxels = 3, .min_planarity = 0.2, .plane_from_voxel = false}, {0.6, 0.2, 0.8}, 12};
}

MatchingStage fine_stage(const VoxelLevel& level, std::span<const Eigen::Vector3d> points, int max_iterations) {
  return {&level,
          points,
          {.search_voxels = 1, .min_planarity = 0.2, .plane_from_voxel = false},
          {0.2, 0.1, 0.6},
          max_iterations};
}

double inlier_share(const RoundsResult& rounds, std::size_t num_points) {
  const std::vector<double> distances = plane_distances(rounds.matches, rounds.local_from_scan);
  const auto inliers = std::count_if(distances.begin(), distances.end(),
                                     [](double distance) { return std::abs(distance) < kInlierDistance; });
  return num_points > 0 ? static_cast<double>(inliers) / static_cast<double>(num_points) : 0;
}

double inlier_rms(const RoundsResult& rounds) {
  double sum = 0;
  double count = 0;
  for (const double distance : plane_distances(rounds.matches, rounds.local_from_scan)) {
    if (std::abs(distance) >= kInlierDistance) continue;
    sum += distance * distance;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

// Whether a scan moved farther than the coarse stage's narrow kernel bridges without false rests.
bool is_far(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  constexpr double kTranslation = 0.8;  // [m]
  constexpr double kRotation = 0.05;    // [rad] 3 degrees
  const Eigen::Isometry3d difference = a.inverse() * b;
  return (a.translation() - b.translation()).norm() > kTranslation ||
         Eigen::AngleAxisd(difference.linear()).angle() > kRotation;
}

Eigen::Isometry3d align_on_coarser_levels(const SampledScan& sample, const VoxelMap& map,
                                          Eigen::Isometry3d local_from_scan, const FineOptions& options) {
  for (std::size_t i = map.levels.size(); i-- > 1;) {
    const MatchingStage stage = coarse_stage(map.levels[i], sample.coarse, options.max_iterations);
    local_from_scan = run_rounds(stage, local_from_scan).local_from_scan;
  }
  return local_from_scan;
}

// Coarser levels from the coarsest down, then the finest.
RoundsResult align_through_levels(const SampledScan& sample, const VoxelMap& map, Eigen::Isometry3d local_from_scan,
                                  const FineOptions& options) {
  local_from_scan = align_on_coarser_levels(sample, map, local_from_scan, options);
  return run_rounds(fine_stage(map.finest(), sample.fine, options.max_iterations), local_from_scan);
}

// The best of several headings, each first settled on the points near by.
RoundsResult align_with_headings(const SampledScan& sample, const VoxelMap& map, const Eigen::Isometry3d& guess,
                                 const FineOptions& options) {
  RoundsResult best;
  double best_share = -1;
  for (const double heading_deg : kHeadings_deg) {
    const Eigen::Vector3d turn = Eigen::Vector3d::UnitZ() * (heading_deg * std::numbers::pi / 180);
    Vector6d motion = Vector6d::Zero();
    motion.head<3>() = turn;
    Eigen::Isometry3d start = moved_by(guess, motion);
    start = run_rounds(near_stage(map.coarsest(), sample.near), start).local_from_scan;
    start = run_rounds(wide_stage(map.coarsest(), sample.coarse), start).local_from_scan;
    start = run_rounds(middle_stage(map.finest(), sample.coarse), start).local_from_scan;
    RoundsResult rounds = align_through_levels(sample, map, start, options);
    const double share = inlier_share(rounds, sample.fine.size());
    if (share <= best_share) continue;
    best_share = share;
    best = std::move(rounds);
  }
  return best;
}

void check_guess(const Eigen::Isometry3d& guess) {
  const Eigen::Matrix3d rotation = guess.linear();
  const bool is_rotation = rotation.allFinite() && guess.translation().allFinite() &&
                           (rotation.transpose() * rotation).isIdentity(1e-3) && rotation.determinant() > 0;
  if (!is_rotation) throw std::invalid_argument("the guess is not a pose: not finite, or not a rotation");
}

// What is left of an alignment's error however little noise there is: planes bend where surfaces meet, and codes of
// normals are coarse. In scenes of known truth the mean error is about this.
Matrix6d systematic_covariance() {
  constexpr double kRotation = 1.5e-5;   // [rad]
  constexpr double kTranslation = 3e-4;  // [m]
  Vector6d variance;
  variance << Eigen::Vector3d::Constant(kRotation * kRotation), Eigen::Vector3d::Constant(kTranslation * kTranslation);
  return variance.asDiagonal();
}

FineResult report(const RoundsResult& rounds, const SampledScan& sample, const VoxelMap& map) {
  FineResult result;
  result.map_from_scan = rounds.local_from_scan;
  result.map_from_scan.translation() += map.frame.anchor;
  result.num_points = sample.fine.size();
  result.inlier_share = inlier_share(rounds, sample.fine.size());
  result.rms_distance = inlier_rms(rounds);
  result.converged = rounds.converged;
  result.covariance = motion_covariance(rounds.matches, rounds.weights, rounds.slopes, rounds.local_from_scan) +
                      systematic_covariance();
  result.unobservable = unobservable_directions(rounds.matches, rounds.weights, rounds.local_from_scan);
  return result;
}

}  // namespace

void FineOptions::check() const {
  require(coarse_spacing > 0.01, "coarse_spacing", coarse_spacing, "more than 0.01 m");
  require(fine_spacing > 0.01, "fine_spacing", fine_spacing, "more than 0.01 m");
  require(range.min >= 0, "range.min", range.min, "0 m or more");
  require(range.max > range.min, "range.max", range.max, "more than range.min");
  require(max_iterations > 0, "max_iterations", max_iterations, "1 or more");
}

FineResult align_sample(const SampledScan& sample, const VoxelMap& map, const Eigen::Isometry3d& map_from_scan_guess,
                        const FineOptions& options) {
  options.check();
  check_guess(map_from_scan_guess);
  if (map.levels.empty()) throw std::invalid_argument("the map has no levels");

  Eigen::Isometry3d guess = map_from_scan_guess;
  guess.translation() -= map.frame.anchor;

  RoundsResult rounds = align_through_levels(sample, map, guess, options);
  const double share = inlier_share(rounds, sample.fine.size());
  if (options.search_headings && (share < kTrustedInlierShare || is_far(rounds.local_from_scan, guess))) {
    RoundsResult other = align_with_headings(sample, map, guess, options);
    if (inlier_share(other, sample.fine.size()) > share) rounds = std::move(other);
  }
  return report(rounds, sample, map);
}

Eigen::Isometry3d align_coarsely(const SampledScan& sample, const VoxelMap& map,
                                 const Eigen::Isometry3d& map_from_scan_guess, const FineOptions& options) {
  options.check();
  check_guess(map_from_scan_guess);
  if (map.levels.empty()) throw std::invalid_argument("the map has no levels");
  Eigen::Isometry3d local_from_scan = map_from_scan_guess;
  local_from_scan.translation() -= map.frame.anchor;
  local_from_scan = run_rounds(wide_stage(map.coarsest(), sample.coarse), local_from_scan).local_from_scan;
  local_from_scan = align_on_coarser_levels(sample, map, local_from_scan, options);
  local_from_scan.translation() += map.frame.anchor;
  return local_from_scan;
}

FineResult align_scan(const PointCloud& scan, const VoxelMap& map, const Eigen::Isometry3d& map_from_scan_guess,
                      const FineOptions& options) {
  options.check();
  const SampledScan sample = sample_scan(scan.positions, options.fine_spacing, options.coarse_spacing, options.range);
  return align_sample(sample, map, map_from_scan_guess, options);
}

}  // namespace vdbmap::registration
