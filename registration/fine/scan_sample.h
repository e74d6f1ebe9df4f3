// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace vdbmap::registration {

/// Distances from the sensor at which points are used [m].
struct RangeLimits {
  double min = 1.0;
  double max = 100.0;
};

/// The positions in the scan of the points that sample_points() returns. Throws std::invalid_argument for 2^32 points
/// or more.
std::vector<std::uint32_t> sample_indices(std::span<const Eigen::Vector3d> points_in_scan, double spacing,
                                          const RangeLimits& limits);

/// The first point of every cube of edge `spacing` [m] among the points within the limits of the scan's origin, in
/// their order: an even cover of the surfaces where a LiDAR is dense near by and sparse far away.
std::vector<Eigen::Vector3d> sample_points(std::span<const Eigen::Vector3d> points_in_scan, double spacing,
                                           const RangeLimits& limits);

}  // namespace vdbmap::registration
