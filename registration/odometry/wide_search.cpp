// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/odometry/wide_search.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "vdbmap/core/parallel.h"

namespace vdbmap::registration {
namespace {

constexpr std::size_t kMaxScoredPoints = 400;  // enough to tell places apart
constexpr double kNearDistance = 1;            // [m] of a point that speaks for a place
constexpr int kMaxRoughIterations = 100;       // a place that is right has mostly come to rest by then

struct Candidate {
  Eigen::Isometry3d map_from_scan;
  double score = 0;
};

// Every n-th point.
std::vector<Eigen::Vector3d> few_of(std::span<const Eigen::Vector3d> points) {
  const std::size_t step = points.size() / kMaxScoredPoints + 1;
  std::vector<Eigen::Vector3d> few;
  for (std::size_t i = 0; i < points.size(); i += step) few.push_back(points[i]);
  return few;
}

std::vector<Candidate> places_around(const Eigen::Isometry3d& guess, const WideSearchOptions& options) {
  const auto num_steps = static_cast<int>(options.radius / options.step);
  const auto num_turns = static_cast<int>(std::lround(options.max_turn / options.turn_step));
  std::vector<Candidate> places;
  for (int turn = -num_turns; turn <= num_turns; ++turn) {
    for (int x = -num_steps; x <= num_steps; ++x) {
      for (int y = -num_steps; y <= num_steps; ++y) {
        Vector6d motion = Vector6d::Zero();
        motion.tail<3>() = options.step * Eigen::Vector3d(x, y, 0);
        if (motion.norm() > options.radius) continue;
        motion.z() = turn * options.turn_step;
        places.push_back({moved_by(guess, motion)});
      }
    }
  }
  return places;
}

double score_of(std::span<const Eigen::Vector3d> points, const LocalMap& map, const Eigen::Isometry3d& map_from_scan) {
  double score = 0;
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d point_in_map = map_from_scan * point;
    if (const auto neighbor = map.nearest(point_in_map, kNearDistance)) {
      score += 1 - (point_in_map - *neighbor).squaredNorm() / (kNearDistance * kNearDistance);
    }
  }
  return score;
}

// The places of the highest scores that are not beside a better one.
std::vector<Candidate> best_of(std::vector<Candidate> places, const WideSearchOptions& options) {
  std::stable_sort(places.begin(), places.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  std::vector<Candidate> best;
  for (const Candidate& place : places) {
    const auto is_beside = [&](const Candidate& other) {
      return (place.map_from_scan.translation() - other.map_from_scan.translation()).norm() < 2 * options.step;
    };
    if (std::ranges::any_of(best, is_beside)) continue;
    best.push_back(place);
    if (best.size() == static_cast<std::size_t>(options.num_candidates)) break;
  }
  return best;
}

}  // namespace

PointToPointResult search_widely(std::span<const Eigen::Vector3d> points_in_scan, const LocalMap& map,
                                 const Eigen::Isometry3d& map_from_scan_guess, const PointToPointOptions& alignment,
                                 const WideSearchOptions& options) {
  const std::vector<Eigen::Vector3d> few = few_of(points_in_scan);
  std::vector<Candidate> places = places_around(map_from_scan_guess, options);
  parallel_for(places.size(), [&](std::size_t i) { places[i].score = score_of(few, map, places[i].map_from_scan); });

  PointToPointOptions rough = alignment;
  rough.max_iterations = std::min(alignment.max_iterations, kMaxRoughIterations);
  PointToPointResult best;
  best.map_from_scan = map_from_scan_guess;
  for (const Candidate& place : best_of(std::move(places), options)) {
    const PointToPointResult result = align_points(points_in_scan, map, place.map_from_scan, rough);
    if (result.matches.num_inliers > best.matches.num_inliers) best = result;
  }
  return align_points(points_in_scan, map, best.map_from_scan, alignment);
}

}  // namespace vdbmap::registration
