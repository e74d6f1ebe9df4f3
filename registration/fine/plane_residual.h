// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "registration/fine/plane_match.h"
#include "registration/rigid_motion.h"

namespace vdbmap::registration {

/// All point-to-plane distances of a scan as one cost function for Ceres' TinySolver: residual i is
/// sqrt(w_i) n_i . (map_from_scan(motion) p_i - m_i) [m], with its analytic Jacobian by the motion.
class PlaneResiduals {
 public:
  using Scalar = double;
  static constexpr int NUM_RESIDUALS = Eigen::Dynamic;
  static constexpr int NUM_PARAMETERS = 6;

  /// Keeps references; `weights` has one entry a match.
  PlaneResiduals(std::span<const PlaneMatch> matches, std::span<const double> weights,
                 const Eigen::Isometry3d& map_from_scan);

  int NumResiduals() const { return static_cast<int>(matches_.size()); }

  /// Residuals and, where `jacobian` is given, the column-major N x 6 Jacobian at `motion`.
  bool operator()(const double* motion, double* residuals, double* jacobian) const;

 private:
  std::span<const PlaneMatch> matches_;
  std::vector<double> sqrt_weights_;
  Eigen::Isometry3d map_from_scan_;
};

/// Signed distances n . (map_from_scan p - m) [m].
std::vector<double> plane_distances(std::span<const PlaneMatch> matches, const Eigen::Isometry3d& map_from_scan);

/// The Jacobian row of a match at no motion: how its distance changes with a motion as in moved_by().
Vector6d sensitivity_to_motion(const PlaneMatch& match, const Eigen::Isometry3d& map_from_scan);

/// Sum of the outer products of the Jacobian rows: the information that the matches hold about the motion, for
/// residuals of 1 m standard deviation.
Matrix6d information(std::span<const PlaneMatch> matches, std::span<const double> weights,
                     const Eigen::Isometry3d& map_from_scan);

}  // namespace vdbmap::registration
