// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>

namespace vdbmap::registration {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// The matrix with cross_matrix(v) * u = v x u.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v);

/// The rotation by a rotation vector [rad] (the exponential map of SO(3)).
Eigen::Matrix3d rotation_of(const Eigen::Vector3d& rotation_vector);

/// Right Jacobian of SO(3): exp(w + d) = exp(w) exp(J_r(w) d) for small d (Sola, Deray & Atchuthan 2018, eq. 143).
Eigen::Matrix3d right_jacobian(const Eigen::Vector3d& rotation_vector);

/// A small motion of the scan in the map: rotation vector [rad] about the sensor, then translation [m]; axes of the
/// map.
Eigen::Isometry3d moved_by(const Eigen::Isometry3d& map_from_scan, const Vector6d& motion);

/// The motion after unit time of a body that moves with a constant twist: angular velocity [rad], then velocity [m],
/// axes of the body (the exponential map of SE(3)).
Eigen::Isometry3d motion_of_twist(const Vector6d& twist);

/// The constant twist that leads to `motion` in unit time, turning by at most pi: the inverse of motion_of_twist().
Vector6d twist_of_motion(const Eigen::Isometry3d& motion);

}  // namespace vdbmap::registration
