// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/fine/observability.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
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

// What tells how fast the sum of weighted distances turns with the motion. A kernel that gives up on far points bends
// the other way there: where that outweighs the rest, the weights stand in.
std::span<const double> curving_weights(std::span<const PlaneMatch> matches, std::span<const double> weights,
                                        std::span<const double> slopes, const Eigen::Isometry3d& map_from_scan) {
  constexpr double kLeastShare = 0.25;
  const Matrix6d of_weights = information(matches, weights, map_from_scan);
  const Matrix6d of_slopes = information(matches, slopes, map_from_scan);
  const Eigen::LDLT<Matrix6d> excess(of_slopes - kLeastShare * of_weights);
  return excess.isPositive() ? slopes : weights;
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

// What the matches of one of the directions in which a scanner turns say: measured at one time, mostly on one thing.
struct Sector {
  Vector6d pull = Vector6d::Zero();         // sum of weight times distance times sensitivity
  Matrix6d information = Matrix6d::Zero();  // share in the sum of all
};

std::vector<Sector> sectors_of(std::span<const PlaneMatch> matches, std::span<const double> weights,
                               std::span<const double> curving, const Eigen::Isometry3d& map_from_scan) {
  constexpr std::size_t kNumSectors = 36;
  std::array<Sector, kNumSectors> all;
  std::array<bool, kNumSectors> is_used{};
  const std::vector<double> distances = plane_distances(matches, map_from_scan);
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const double turn = std::atan2(matches[i].point.y(), matches[i].point.x()) / (2 * std::numbers::pi) + 0.5;
    const auto number = std::min(static_cast<std::size_t>(turn * kNumSectors), kNumSectors - 1);
    const Vector6d row = sensitivity_to_motion(matches[i], map_from_scan);
    all[number].pull += weights[i] * distances[i] * row;
    all[number].information += curving[i] * row * row.transpose();
    is_used[number] = true;
  }
  std::vector<Sector> used;
  for (std::size_t i = 0; i < kNumSectors; ++i) {
    if (is_used[i]) used.push_back(all[i]);
  }
  return used;
}

// The spread of the motions that the scan would make without one sector after the other: so errors that belong together
// count as one, as they do where the scanner was elsewhere at that time than deskewing thinks, or a surface is not the
// plane it is taken for.
Matrix6d jackknife_covariance(std::span<const Sector> sectors, const Matrix6d& bread_and_prior) {
  Matrix6d covariance = Matrix6d::Zero();
  for (const Sector& sector : sectors) {
    const Vector6d motion = (bread_and_prior - sector.information).ldlt().solve(sector.pull);
    covariance += motion * motion.transpose();
  }
  const auto count = static_cast<double>(sectors.size());
  return (count - 1) / count * covariance;
}

// A covariance, and in directions in which another is wider, that one, if it is so on the whole: of 36 sums the spread
// is known to a quarter only, which is too little to correct a covariance that is nearly right.
Matrix6d widened(const Matrix6d& covariance, const Matrix6d& other) {
  constexpr double kClearRatio = 3;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> solver(other, covariance);
  if (solver.info() != Eigen::Success || solver.eigenvalues().mean() < kClearRatio) return covariance;
  const Matrix6d basis = covariance * solver.eigenvectors();  // V^-T, as V^T C V = 1
  const Matrix6d wide = basis * solver.eigenvalues().cwiseMax(1.0).asDiagonal() * basis.transpose();
  return 0.5 * (wide + wide.transpose());
}

}  // namespace

Matrix6d motion_covariance(std::span<const PlaneMatch> matches, std::span<const double> weights,
                           std::span<const double> slopes, const Eigen::Isometry3d& map_from_scan) {
  const std::span<const double> curving = curving_weights(matches, weights, slopes, map_from_scan);
  const Matrix6d bread = information(matches, curving, map_from_scan);
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
  const Matrix6d sandwich = inverse * (filling + noise * prior) * inverse;
  const Matrix6d covariance = 0.5 * (sandwich + sandwich.transpose());

  constexpr std::size_t kLeastSectors = 18;  // of fewer, and of few matches each, the spread tells too little
  constexpr std::size_t kLeastMatches = 20;
  const std::vector<Sector> sectors = sectors_of(matches, weights, curving, map_from_scan);
  if (sectors.size() < kLeastSectors || matches.size() < kLeastMatches * sectors.size()) return covariance;
  return widened(covariance, jackknife_covariance(sectors, bread + prior));
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
