// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace vdbmap {

/// Shape of a point distribution from the eigenvalues l1 >= l2 >= l3 of its covariance (Weinmann 2015); all zero where
/// the covariance is zero.
struct EigenFeatures {
  Eigen::Vector3d eigenvalues = Eigen::Vector3d::Zero();  ///< descending [m^2]
  double linearity = 0;                                   ///< (l1 - l2) / l1
  double planarity = 0;                                   ///< (l2 - l3) / l1
  double scattering = 0;                                  ///< l3 / l1
  double omnivariance = 0;                                ///< (l1 l2 l3)^(1/3) [m^2]
  double anisotropy = 0;                                  ///< (l1 - l3) / l1
  double eigenentropy = 0;                                ///< -sum e_i ln e_i of the shares e_i = l_i / (l1 + l2 + l3)
  double surface_variation = 0;                           ///< l3 / (l1 + l2 + l3)
  double verticality = 0;                                 ///< 1 - |n_z| of the normal n
};

/// Features of a covariance [m^2].
EigenFeatures eigen_features(const Eigen::Matrix3d& covariance);

/// Plane through a distribution.
struct PlaneFit {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, z >= 0: the eigenvector of the smallest eigenvalue
  double planarity = 0;                               ///< (l2 - l3) / l1, 0 to 1
};

/// Normal and planarity of a covariance [m^2]; planarity 0 where it has no extent.
PlaneFit fit_plane(const Eigen::Matrix3d& covariance);

/// The normal with the one sign that stands for its plane: up, and where the plane is upright towards positive x, then
/// y.
Eigen::Vector3d upward(const Eigen::Vector3d& normal);

}  // namespace vdbmap
