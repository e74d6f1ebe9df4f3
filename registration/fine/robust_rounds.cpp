// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/fine/robust_rounds.h"

#include <algorithm>
#include <cmath>

#include "registration/fine/plane_residual.h"
#include "registration/fine/solver_step.h"

namespace vdbmap::registration {
namespace {

constexpr double kRestingTranslation = 1e-3;  // [m]
constexpr double kRestingRotation = 1.75e-4;  // [rad] 0.01 degrees

// Geman & McClure's kernel: the weight of a residual at `distance`.
double robust_weight(double distance, double scale) {
  const double ratio = distance / scale;
  const double denominator = 1 + ratio * ratio;
  return 1 / (denominator * denominator);
}

// The derivative of weight times distance by the distance.
double robust_slope(double distance, double scale) {
  const double ratio = distance / scale;
  const double denominator = 1 + ratio * ratio;
  return (1 - 3 * ratio * ratio) / (denominator * denominator * denominator);
}

std::vector<double> robust_weights(std::span<const PlaneMatch> matches, const Eigen::Isometry3d& local_from_scan,
                                   double scale) {
  std::vector<double> weights = plane_distances(matches, local_from_scan);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights[i] = matches[i].planarity * robust_weight(weights[i], scale);
  }
  return weights;
}

std::vector<double> robust_slopes(std::span<const PlaneMatch> matches, const Eigen::Isometry3d& local_from_scan,
                                  double scale) {
  std::vector<double> slopes = plane_distances(matches, local_from_scan);
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    slopes[i] = matches[i].planarity * robust_slope(slopes[i], scale);
  }
  return slopes;
}

bool is_at_rest(const Vector6d& motion) {
  return motion.head<3>().norm() < kRestingRotation && motion.tail<3>().norm() < kRestingTranslation;
}

}  // namespace

RoundsResult run_rounds(const MatchingStage& stage, const Eigen::Isometry3d& local_from_scan_guess) {
  constexpr std::size_t kMinMatches = 6;  // unknowns of a pose
  RoundsResult result;
  result.local_from_scan = local_from_scan_guess;
  double kernel = stage.kernel.first;
  for (int round = 0; round < stage.max_rounds && !result.converged; ++round) {
    result.matches = match_planes(stage.points, *stage.level, result.local_from_scan, stage.match);
    if (result.matches.size() < kMinMatches) break;
    const bool is_last_kernel = kernel <= stage.kernel.last;
    result.weights = robust_weights(result.matches, result.local_from_scan, kernel);
    // One step: the weights stand for the kernel at this pose only.
    const SolverStep step = step_towards_planes(result.matches, result.weights, result.local_from_scan);
    result.local_from_scan = moved_by(result.local_from_scan, step.motion);
    result.converged = is_last_kernel && is_at_rest(step.proposed);
    kernel = std::max(stage.kernel.last, kernel * stage.kernel.factor);
  }
  result.weights = robust_weights(result.matches, result.local_from_scan, stage.kernel.last);
  result.slopes = robust_slopes(result.matches, result.local_from_scan, stage.kernel.last);
  return result;
}

}  // namespace vdbmap::registration
