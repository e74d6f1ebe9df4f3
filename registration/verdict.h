// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include <Eigen/Geometry>

#include "registration/evidence.h"
#include "registration/fine/point_to_plane.h"

namespace vdbmap::registration {

/// When a pose found without a guess is believed.
struct VerdictOptions {
  double min_overlap = 0.3;        ///< share of the points that have the map near by
  double min_agreement = 0.52;     ///< surface_agreement(); on KITTI streets true poses reach 0.56, others 0.47
  double max_blocked_share = 0.6;  ///< of the rays: through solid map; what has moved since blocks some
  double min_margin = 1.2;         ///< agreement of the best pose by that of the next best
  double max_deviation = 0.25;     ///< [m] standard deviation of the place in its least certain direction
  std::size_t min_points = 200;    ///< sampled points of a batch, 1.5 m apart

  /// Throws std::invalid_argument naming the value and what is allowed.
  void check() const;
};

/// A pose of the batch, aligned as well as may be.
struct BatchCandidate {
  Eigen::Isometry3d map_from_batch = Eigen::Isometry3d::Identity();  ///< original system
  Eigen::Isometry3d coarse_guess = Eigen::Isometry3d::Identity();    ///< the same before it was aligned
  std::size_t num_feature_inliers = 0;                               ///< of the coarse search
  double agreement = 0;                                              ///< surface_agreement()
  Evidence evidence;
  Matrix6d covariance = Matrix6d::Zero();  ///< as FineResult::covariance
};

/// Why a batch of so few sampled points is not looked for; empty when it is.
std::string reason_too_few(std::size_t num_points, const VerdictOptions& verdict);

/// Why the first of the candidates, the best, is not believed, alone and beside the second; empty when it is. A new
/// reason goes here.
std::string reason_not_found(std::span<const BatchCandidate> candidates, const VerdictOptions& verdict);

}  // namespace vdbmap::registration
