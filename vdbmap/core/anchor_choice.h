// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include <Eigen/Geometry>

#include "vdbmap/core/point_cloud.h"

namespace vdbmap {

/// The anchor of a map whose first cloud, which is not empty, is moved by `map_from_cloud`: choose_anchor() of its
/// first point where voxel ids reach more than half of the points from there, else of the medians of its coordinates,
/// which a few stray points do not move. Throws std::out_of_range where the points lie farther out than an anchor may.
Eigen::Vector3d anchor_for(const PointCloud& cloud, const Eigen::Isometry3d& map_from_cloud, double voxels_per_metre);

/// How many points of a cloud voxel ids reach from an anchor.
std::size_t count_reached(const Eigen::Vector3d& anchor, const PointCloud& cloud,
                          const Eigen::Isometry3d& map_from_cloud, double voxels_per_metre);

}  // namespace vdbmap
