// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace vdbmap {

/// The rotation R that is nearest to M: trace(R^T M) is greatest (Umeyama 1991, equations 40 and 43, with scale 1). Of
/// M = sum of (target - mean of targets) (source - mean of sources)^T it turns sources to targets by least squares.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix);

}  // namespace vdbmap
