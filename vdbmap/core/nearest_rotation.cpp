// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/nearest_rotation.h"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace vdbmap {

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double handedness = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * Eigen::Vector3d(1, 1, handedness).asDiagonal() * svd.matrixV().transpose();
}

}  // namespace vdbmap
