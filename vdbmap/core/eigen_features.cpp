// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/eigen_features.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace vdbmap {
namespace {

double entropy_term(double share) { return share > 0 ? -share * std::log(share) : 0; }

}  // namespace

EigenFeatures eigen_features(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  EigenFeatures features;
  features.eigenvalues = solver.eigenvalues().reverse().cwiseMax(0.0);

  const auto [l1, l2, l3] = std::array{features.eigenvalues[0], features.eigenvalues[1], features.eigenvalues[2]};
  if (l1 <= 0) return features;
  const double sum = l1 + l2 + l3;
  features.linearity = (l1 - l2) / l1;
  features.planarity = (l2 - l3) / l1;
  features.scattering = l3 / l1;
  features.omnivariance = std::cbrt(l1 * l2 * l3);
  features.anisotropy = (l1 - l3) / l1;
  features.eigenentropy = entropy_term(l1 / sum) + entropy_term(l2 / sum) + entropy_term(l3 / sum);
  features.surface_variation = l3 / sum;
  features.verticality = 1 - std::abs(solver.eigenvectors()(2, 0));
  return features;
}

PlaneFit fit_plane(const Eigen::Matrix3d& covariance) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  const Eigen::Vector3d& values = solver.eigenvalues();  // ascending

  PlaneFit plane;
  if (!(values[2] > 0)) return plane;
  plane.normal = upward(solver.eigenvectors().col(0));
  plane.planarity = std::clamp((values[1] - values[0]) / values[2], 0.0, 1.0);
  return plane;
}

Eigen::Vector3d upward(const Eigen::Vector3d& normal) {
  constexpr double kUpright = 1e-6;
  for (const int axis : {2, 0, 1}) {
    if (std::abs(normal[axis]) > kUpright) return normal[axis] > 0 ? normal : Eigen::Vector3d(-normal);
  }
  return normal;
}

}  // namespace vdbmap
