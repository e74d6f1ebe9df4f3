// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/fine/plane_residual.h"

#include <cmath>

namespace vdbmap::registration {

PlaneResiduals::PlaneResiduals(std::span<const PlaneMatch> matches, std::span<const double> weights,
                               const Eigen::Isometry3d& map_from_scan)
    : matches_(matches), sqrt_weights_(weights.size()), map_from_scan_(map_from_scan) {
  for (std::size_t i = 0; i < weights.size(); ++i) sqrt_weights_[i] = std::sqrt(weights[i]);
}

bool PlaneResiduals::operator()(const double* motion, double* residuals, double* jacobian) const {
  const Eigen::Map<const Vector6d> step(motion);
  const Eigen::Isometry3d moved = moved_by(map_from_scan_, step);
  const Eigen::Matrix3d motion_rotation = rotation_of(step.head<3>());
  const Eigen::Matrix3d motion_jacobian = right_jacobian(step.head<3>());

  const auto rows = static_cast<Eigen::Index>(matches_.size());
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 6>> by_motion(jacobian, jacobian ? rows : 0, 6);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const PlaneMatch& match = matches_[static_cast<std::size_t>(i)];
    const double scale = sqrt_weights_[static_cast<std::size_t>(i)];
    residuals[i] = scale * match.normal.dot(moved * match.point - match.mean);
    if (!jacobian) continue;
    // d(exp(w) v)/dw = -exp(w) [v]x J_r(w), with v the point seen from the sensor in the map's axes.
    const Eigen::Vector3d arm = map_from_scan_.linear() * match.point;
    const Eigen::Vector3d normal = motion_rotation.transpose() * match.normal;
    by_motion.row(i).head<3>() = scale * arm.cross(normal).transpose() * motion_jacobian;
    by_motion.row(i).tail<3>() = scale * match.normal.transpose();
  }
  return true;
}

std::vector<double> plane_distances(std::span<const PlaneMatch> matches, const Eigen::Isometry3d& map_from_scan) {
  std::vector<double> distances;
  distances.reserve(matches.size());
  for (const PlaneMatch& match : matches) {
    distances.push_back(match.normal.dot(map_from_scan * match.point - match.mean));
  }
  return distances;
}

Vector6d sensitivity_to_motion(const PlaneMatch& match, const Eigen::Isometry3d& map_from_scan) {
  const Eigen::Vector3d arm = map_from_scan.linear() * match.point;
  Vector6d row;
  row.head<3>() = arm.cross(match.normal);
  row.tail<3>() = match.normal;
  return row;
}

Matrix6d information(std::span<const PlaneMatch> matches, std::span<const double> weights,
                     const Eigen::Isometry3d& map_from_scan) {
  Matrix6d sum = Matrix6d::Zero();
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const Vector6d row = sensitivity_to_motion(matches[i], map_from_scan);
    sum += weights[i] * row * row.transpose();
  }
  return sum;
}

}  // namespace vdbmap::registration
