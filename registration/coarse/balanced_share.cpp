// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/coarse/balanced_share.h"

#include <Eigen/LU>

namespace vdbmap::registration {

double balanced_share(std::span<const Eigen::Vector3d> normals, const std::vector<bool>& holds) {
  constexpr double kRegularization = 1e-3;  // of the mean: a direction without surfaces must not decide
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& normal : normals) sum += normal * normal.transpose();
  const double regularization = kRegularization * static_cast<double>(normals.size()) + 1e-12;
  const Eigen::Matrix3d inverse = (sum + regularization * Eigen::Matrix3d::Identity()).inverse();
  double total = 0;
  double holding = 0;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const double leverage = normals[i].dot(inverse * normals[i]);
    total += leverage;
    if (holds[i]) holding += leverage;
  }
  return total > 0 ? holding / total : 0;
}

}  // namespace vdbmap::registration
