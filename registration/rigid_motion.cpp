// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/rigid_motion.h"

#include <cmath>

namespace vdbmap::registration {
namespace {

// By the quaternion: the trace of a matrix cannot tell small angles from zero.
Eigen::Vector3d rotation_vector_of(const Eigen::Matrix3d& rotation) {
  Eigen::Quaterniond turn(rotation);
  if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
  const double sine = turn.vec().norm();
  if (sine < 1e-9) return 2 * turn.vec();
  return 2 * std::atan2(sine, turn.w()) / sine * turn.vec();
}

// Maps the velocity of a twist to its translation; the left Jacobian of SO(3) (ibid., eq. 174).
Eigen::Matrix3d translation_of_velocity(const Eigen::Vector3d& rotation_vector) {
  return right_jacobian(-rotation_vector);
}

}  // namespace

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

Eigen::Matrix3d rotation_of(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (angle < 1e-12) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, rotation_vector / angle).toRotationMatrix();
}

Eigen::Matrix3d right_jacobian(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  const Eigen::Matrix3d cross = cross_matrix(rotation_vector);
  if (angle < 1e-6) return Eigen::Matrix3d::Identity() - 0.5 * cross;
  const double squared = angle * angle;
  return Eigen::Matrix3d::Identity() - (1 - std::cos(angle)) / squared * cross +
         (angle - std::sin(angle)) / (squared * angle) * cross * cross;
}

Eigen::Isometry3d moved_by(const Eigen::Isometry3d& map_from_scan, const Vector6d& motion) {
  Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
  // Normalized: poses that are chained (the next predicted by the last two) would double rounding errors each time.
  const Eigen::Quaterniond rotation(rotation_of(motion.head<3>()) * map_from_scan.linear());
  moved.linear() = rotation.normalized().toRotationMatrix();
  moved.translation() = map_from_scan.translation() + motion.tail<3>();
  return moved;
}

Eigen::Isometry3d motion_of_twist(const Vector6d& twist) {
  const Eigen::Vector3d rotation_vector = twist.head<3>();
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = rotation_of(rotation_vector);
  motion.translation() = translation_of_velocity(rotation_vector) * twist.tail<3>();
  return motion;
}

Vector6d twist_of_motion(const Eigen::Isometry3d& motion) {
  const Eigen::Vector3d rotation_vector = rotation_vector_of(motion.linear());
  Vector6d twist;
  twist.head<3>() = rotation_vector;
  twist.tail<3>() = translation_of_velocity(rotation_vector).inverse() * motion.translation();
  return twist;
}

}  // namespace vdbmap::registration
