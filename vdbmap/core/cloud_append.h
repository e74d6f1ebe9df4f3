// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>

#include "vdbmap/core/point_cloud.h"

namespace vdbmap {

/// Adds the points of `part`, moved, to a cloud. The cloud keeps an attribute only as long as every part has it: there
/// is no value for the points without.
void append_cloud(PointCloud& cloud, const PointCloud& part, const Eigen::Isometry3d& cloud_from_part);

}  // namespace vdbmap
