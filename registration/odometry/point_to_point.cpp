// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/odometry/point_to_point.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "registration/odometry/require_positive.h"
#include "vdbmap/core/parallel.h"

namespace vdbmap::registration {
namespace {

constexpr std::size_t kMinMatches = 6;  // as many as unknowns
constexpr std::size_t kPointsPerCluster = 32;

// Points near each other have the same errors of the map in their residuals, more than the clusters show: on KITTI
// streets, with 64 rings and with 16, and on synthetic ones the squares of the errors are 16 to 19 times as large.
constexpr double kCorrelation = 17;

constexpr std::size_t kPointsPerPart = 256;  // summed one after the other, whatever the number of threads

// A point and its neighbour: residual r, Jacobian J = (-[arm]x, I).
struct Match {
  Eigen::Vector3d arm;       // from the sensor to the point, axes of the map
  Eigen::Vector3d residual;  // from the neighbour to the point

  // J^T r
  Vector6d pull() const {
    Vector6d pull;
    pull.head<3>() = arm.cross(residual);
    pull.tail<3>() = residual;
    return pull;
  }
};

// kappa / (kappa + r^2), the root of the weight.
double kernel_ratio(const Match& match, const MatchLimits& limits) {
  return limits.kernel / (limits.kernel + match.residual.squaredNorm());
}

// Calls body(match, part) for each point that has a neighbour. Parts of fixed size follow one another in their order;
// within one, so do the points.
template <typename Sums, typename Body>
std::vector<Sums> for_matches(std::span<const Eigen::Vector3d> points_in_scan, const LocalMap& map,
                              const Eigen::Isometry3d& map_from_scan, double max_distance, std::size_t points_per_part,
                              const Body& body) {
  std::vector<Sums> parts((points_in_scan.size() + points_per_part - 1) / points_per_part);
  parallel_for(parts.size(), [&](std::size_t part) {
    const std::size_t begin = part * points_per_part;
    const std::size_t end = std::min(begin + points_per_part, points_in_scan.size());
    Sums sums;
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d arm = map_from_scan.linear() * points_in_scan[i];
      const Eigen::Vector3d point = arm + map_from_scan.translation();
      const auto neighbor = map.nearest(point, max_distance);
      if (neighbor) body(Match{arm, point - *neighbor}, sums);
    }
    parts[part] = sums;
  });
  return parts;
}

// The products by J written out, the upper triangle of the information only.
void add(const Match& match, const MatchLimits& limits, MatchSums& sums) {
  const double squared = match.residual.squaredNorm();
  const double ratio = kernel_ratio(match, limits);
  const double weight = ratio * ratio;
  const Eigen::Matrix3d cross = weight * cross_matrix(match.arm);
  sums.cost += 0.5 * ratio * squared;
  sums.gradient += weight * match.pull();
  sums.information.topLeftCorner<3, 3>() -= cross * cross_matrix(match.arm);
  sums.information.topRightCorner<3, 3>() += cross;
  sums.information.bottomRightCorner<3, 3>().diagonal().array() += weight;
  ++sums.num_matches;
  if (squared <= limits.inlier_distance * limits.inlier_distance) ++sums.num_inliers;
}

void add(const MatchSums& part, MatchSums& sums) {
  sums.cost += part.cost;
  sums.gradient += part.gradient;
  sums.information += part.information;
  sums.num_matches += part.num_matches;
  sums.num_inliers += part.num_inliers;
}

// Sum of w J^T r.
struct Pull {
  Vector6d sum = Vector6d::Zero();
};

// Sum of the outer products of the pulls, points near each other in the scan taken together.
Matrix6d scatter_of(std::span<const Eigen::Vector3d> points_in_scan, const LocalMap& map,
                    const Eigen::Isometry3d& map_from_scan, const MatchLimits& limits) {
  const auto add_pull = [&](const Match& match, Pull& pull) {
    const double ratio = kernel_ratio(match, limits);
    pull.sum += ratio * ratio * match.pull();
  };
  Matrix6d scatter = Matrix6d::Zero();
  for (const Pull& part :
       for_matches<Pull>(points_in_scan, map, map_from_scan, limits.max_distance, kPointsPerCluster, add_pull)) {
    scatter += part.sum * part.sum.transpose();
  }
  return scatter;
}

}  // namespace

void MatchLimits::check() const {
  require_positive("max_distance", max_distance);
  require_positive("kernel", kernel);
  require_positive("inlier_distance", inlier_distance);
}

MatchSums sum_matches(std::span<const Eigen::Vector3d> points_in_scan, const LocalMap& map,
                      const Eigen::Isometry3d& map_from_scan, const MatchLimits& limits) {
  const auto parts = for_matches<MatchSums>(points_in_scan, map, map_from_scan, limits.max_distance, kPointsPerPart,
                                            [&](const Match& match, MatchSums& sums) { add(match, limits, sums); });
  MatchSums sums;
  for (const MatchSums& part : parts) add(part, sums);
  sums.information = sums.information.selfadjointView<Eigen::Upper>();
  return sums;
}

std::optional<Matrix6d> match_covariance(std::span<const Eigen::Vector3d> points_in_scan, const LocalMap& map,
                                         const Eigen::Isometry3d& map_from_scan, const MatchLimits& limits) {
  const MatchSums sums = sum_matches(points_in_scan, map, map_from_scan, limits);
  const Eigen::FullPivLU<Matrix6d> solver(sums.information);
  if (sums.num_matches < kMinMatches || !solver.isInvertible()) return std::nullopt;
  const Matrix6d inverse = solver.inverse();
  const Matrix6d covariance =
      kCorrelation * inverse * scatter_of(points_in_scan, map, map_from_scan, limits) * inverse.transpose();
  return 0.5 * (covariance + covariance.transpose());
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
