// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/fine/pose_estimate.h"

namespace vdbmap::registration {

PoseEstimate carried(const PoseEstimate& scan, const Eigen::Isometry3d& scan_from_other) {
  Matrix6d motion_of_other = Matrix6d::Identity();  // as in moved_by()
  motion_of_other.bottomLeftCorner<3, 3>() = -cross_matrix(scan.map_from_scan.linear() * scan_from_other.translation());
  return {scan.map_from_scan * scan_from_other, motion_of_other * scan.covariance * motion_of_other.transpose()};
}

}  // namespace vdbmap::registration
