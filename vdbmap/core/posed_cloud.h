// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "vdbmap/core/measured_ray.h"
#include "vdbmap/core/point_cloud.h"

namespace vdbmap {

/// Points, and from where they were measured.
struct PosedCloud {
  const PointCloud& cloud;
  Eigen::Isometry3d map_from_cloud;                   ///< original system
  std::span<const Eigen::Vector3d> origins_in_cloud;  ///< [m] of the rays: one for all points, or one a point
};

/// Goes through the clouds of a drive, in the same order each time it is called.
using CloudSource = std::function<void(const std::function<void(const PosedCloud&)>& take)>;

/// The rays of a cloud [m, local frame of `anchor`]. Throws std::invalid_argument where there is neither one origin nor
/// one a point.
std::vector<MeasuredRay> rays_of(const PosedCloud& posed, const Eigen::Vector3d& anchor);

}  // namespace vdbmap
