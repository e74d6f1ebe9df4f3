// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/odometry/point_to_point.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Cholesky>

#include "vdbmap/core/parallel.h"

namespace vdbmap::registration {
namespace {

constexpr std::size_t kMinMatches = 6;       // as many as unknowns
constexpr std::size_t kPointsPerPart = 256;  // summed one after the other, whatever the number of threads

// A point and its neighbour.
struct Match {
  Eigen::Vector3d arm;       // from the sensor to the point, axes of the map
  Eigen::Vector3d residual;  // from the neighbour to the point
};

void add(MatchSums& sums, const Match& match, const MatchLimits& limits) {
  const double squared = match.residual.squaredNorm();
  const double ratio = limits.kernel / (limits.kernel + squared);
  const double weight = ratio * ratio;

  // J = (-[arm]x, I), written out: the sums by J^T need no product of matrices.
  Vector6d pull;
  pull.head<3>() = match.arm.cross(match.residual);
  pull.tail<3>() = match.residual;
  const Eigen::Matrix3d cross = weight * cross_matrix(match.arm);
  sums.cost += 0.5 * ratio * squared;
  sums.gradient += weight * pull;
  sums.information.topLeftCorner<3, 3>() -= cross * cross_matrix(match.arm);
  sums.information.topRightCorner<3, 3>() += cross;
  sums.information.bottomRightCorner<3, 3>().diagonal().array() += weight;
  sums.scatter.triangularView<Eigen::Upper>() += (weight * pull) * (weight * pull).transpose();
  ++sums.num_matches;
  if (squared <= limits.inlier_distance * limits.inlier_distance) ++sums.num_inliers;
}

MatchSums sum_part(std::span<const Eigen::Vector3d> points_in_scan, const LocalMap& map,
                   const Eigen::Isometry3d& map_from_scan, const MatchLimits& limits) {
  MatchSums sums;
  for (const Eigen::Vector3d& point : points_in_scan) {
    const Eigen::Vector3d arm = map_from_scan.linear() * point;
    const Eigen::Vector3d point_in_map = arm + map_from_scan.translation();
    const auto neighbor = map.nearest(point_in_map, limits.max_distance);
    if (neighbor) add(sums, {arm, point_in_map - *neighbor}, limits);
  }
  return sums;
}

void add(MatchSums& sums, const MatchSums& part) {
  sums.cost += part.cost;
  sums.gradient += part.gradient;
  sums.information += part.information;
  sums.scatter += part.scatter;
  sums.num_matches += part.num_matches;
  sums.num_inliers += part.num_inliers;
}

void require_positive(const char* name, double value) {
  if (value > 0) return;
  throw std::invalid_argument(std::string(name) + " is " + std::to_string(value) + ", expected more than 0");
}

}  // namespace

void MatchLimits::check() const {
  require_positive("max_distance", max_distance);
  require_positive("kernel", kernel);
  require_positive("inlier_distance", inlier_distance);
}

MatchSums sum_matches(std::span<const Eigen::Vector3d> points_in_scan, const LocalMap& map,
                      const Eigen::Isometry3d& map_from_scan, const MatchLimits& limits) {
  std::vector<MatchSums> parts((points_in_scan.size() + kPointsPerPart - 1) / kPointsPerPart);
  parallel_for(parts.size(), [&](std::size_t part) {
    const std::size_t begin = part * kPointsPerPart;
    const std::size_t count = std::min(kPointsPerPart, points_in_scan.size() - begin);
    parts[part] = sum_part(points_in_scan.subspan(begin, count), map, map_from_scan, limits);
  });
  MatchSums sums;
  for (const MatchSums& part : parts) add(sums, part);
  sums.information = sums.information.selfadjointView<Eigen::Upper>();
  sums.scatter = sums.scatter.selfadjointView<Eigen::Upper>();
  return sums;
}

PointToPointResult align_points(std::span<const Eigen::Vector3d> points_in_scan, const LocalMap& map,
                                const Eigen::Isometry3d& map_from_scan_guess, const PointToPointOptions& options) {
  options.limits.check();
  PointToPointResult result;
  result.map_from_scan = map_from_scan_guess;
  result.matches = sum_matches(points_in_scan, map, result.map_from_scan, options.limits);
  while (!result.converged && result.num_iterations < options.max_iterations &&
         result.matches.num_matches >= kMinMatches) {
    const Vector6d motion = result.matches.information.ldlt().solve(-result.matches.gradient);
    if (!motion.allFinite()) break;
    result.map_from_scan = moved_by(result.map_from_scan, motion);
    result.matches = sum_matches(points_in_scan, map, result.map_from_scan, options.limits);
    result.converged = motion.norm() < options.convergence;
    ++result.num_iterations;
  }
  return result;
}

}  // namespace vdbmap::registration
