// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/fine/observability.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <numeric>

#include <Eigen/Eigenvalues>

namespace vdbmap::registration {
namespace {

constexpr double kLever = 10;             // [m] makes a rotation comparable with a translation
constexpr double kMinSensitivity = 0.03;  // change of the distances per unit of motion, root mean square

// Standard deviations of the guesses that fine registration accepts.
constexpr double kGuessRotation = 0.1745;  // [rad] 10 degrees
constexpr double kGuessTranslation = 2;    // [m]

Vector6d lever_scale() {
  Vector6d scale = Vector6d::Ones();
  scale.head<3>() /= kLever;
  return scale;
}

std::string describe(const Vector6d& motion) {
  const bool is_rotation = motion.head<3>().norm() > motion.tail<3>().norm();
  const Eigen::Vector3d axis = (is_rotation ? motion.head<3>() : motion.tail<3>()).normalized();
  std::array<char, 96> text;
  std::snprintf(text.data(), text.size(), "%s (%.2f, %.2f, %.2f)", is_rotation ? "rotation about" : "translation along",
                axis.x(), axis.y(), axis.z());
  return text.data();
}

// How fast the sum of weighted distances turns with the motion. A kernel that gives up on far points bends the other
// way there: where that outweighs the rest, the weights stand in.
Matrix6d curvature(std::span<const PlaneMatch> matches, std::span<const double> weights, std::span<const double> slopes,
                   const Eigen::Isometry3d& map_from_scan) {
  constexpr double kLeastShare = 0.25;
  const Matrix6d of_weights = information(matches, weights, map_from_scan);
  const Matrix6d of_slopes = information(matches, slopes, map_from_scan);
  const Eigen::LDLT<Matrix6d> excess(of_slopes - kLeastShare * of_weights);
  return excess.isPositive() ? of_slopes : of_weights;
}

// Squares of weight times distance, as far as the match did not draw the scan to itself: by the leverage h of each
// match they are a factor (1 - h)^2 too small (HC3 of MacKinnon & White 1985), which tells where points are few.
std::vector<double> squared_pulls_of(std::span<const PlaneMatch> matches, std::span<const double> weights,
                                     const Eigen::Isometry3d& map_from_scan) {
  constexpr double kMaxLeverage = 0.9;
  const Eigen::LDLT<Matrix6d> of_weights(information(matches, weights, map_from_scan) + 1e-9 * Matrix6d::Identity());
  std::vector<double> squared_pulls = plane_distances(matches, map_from_scan);
  for (std::size_t i = 0; i < squared_pulls.size(); ++i) {
    const Vector6d row = sensitivity_to_motion(matches[i], map_from_scan);
    const double leverage = std::min(weights[i] * row.dot(of_weights.solve(row)), kMaxLeverage);
    const double pull = weights[i] * squared_pulls[i] / (1 - leverage);
    squared_pulls[i] = pull * pull;
  }
  return squared_pulls;
}

}  // namespace

Matrix6d motion_covariance(std::span<const PlaneMatch> matches, std::span<const double> weights,
                           std::span<const double> slopes, const Eigen::Isometry3d& map_from_scan) {
  const Matrix6d bread = curvature(matches, weights, slopes, map_from_scan);
  const std::vector<double> squared_pulls = squared_pulls_of(matches, weights, map_from_scan);
  const Matrix6d filling = information(matches, squared_pulls, map_from_scan);

  // The prior belongs to unit noise; scaled by the noise it only shows where the planes say nothing.
  Vector6d prior_variance;
  prior_variance << Eigen::Vector3d::Constant(kGuessRotation * kGuessRotation),
      Eigen::Vector3d::Constant(kGuessTranslation * kGuessTranslation);
  constexpr double kMinNoise = 1e-12;  // [m^2] a micrometre: even perfect or missing matches leave the prior in place
  const double noise = std::max(filling.trace() / std::max(bread.trace(), 1e-12), kMinNoise);
  const Matrix6d prior = (noise * prior_variance.cwiseInverse()).asDiagonal();
  const Matrix6d inverse = (bread + prior).ldlt().solve(Matrix6d::Identity());
  const Matrix6d covariance = inverse * (filling + noise * prior) * inverse;
  return 0.5 * (covariance + covariance.transpose());
}

std::vector<UnobservableDirection> unobservable_directions(std::span<const PlaneMatch> matches,
                                                           std::span<const double> weights,
                                                           const Eigen::Isometry3d& map_from_scan) {
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  const Vector6d scale = lever_scale();
  Matrix6d sensitivity = Matrix6d::Zero();
  if (total > 0) {
    sensitivity = scale.asDiagonal() * information(matches, weights, map_from_scan) * scale.asDiagonal() / total;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(sensitivity);
  std::vector<UnobservableDirection> directions;
  for (int i = 0; i < 6; ++i) {
    if (solver.eigenvalues()[i] >= kMinSensitivity * kMinSensitivity) break;  // ascending
    const Vector6d motion = solver.eigenvectors().col(i);
    directions.push_back({motion, describe(motion)});
  }
  return directions;
}

}  // namespace vdbmap::registration
