// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "vdbmap/core/range_limits.h"

namespace vdbmap::registration {

/// The positions in the scan of the points that sample_points() returns. Throws std::invalid_argument for 2^32 points
/// or more.
std::vector<std::uint32_t> sample_indices(std::span<const Eigen::Vector3d> points_in_scan, double spacing,
                                          const RangeLimits& limits);

/// The first point of every cube of edge `spacing` [m] among the points within the limits of the scan's origin, in
/// their order: an even cover of the surfaces where a LiDAR is dense near by and sparse far away.
std::vector<Eigen::Vector3d> sample_points(std::span<const Eigen::Vector3d> points_in_scan, double spacing,
                                           const RangeLimits& limits);

/// A scan ready for alignment: evenly thinned, densely for the finest level, thinly for the coarser ones.
struct SampledScan {
  std::vector<Eigen::Vector3d> fine;    ///< [m] in the frame of the scan, as are the others
  std::vector<Eigen::Vector3d> coarse;  ///< some of `fine`
  std::vector<Eigen::Vector3d> near;    ///< those of `coarse` that a wrong heading moves least
};

/// Thins a scan for both kinds of levels, its points in shuffled() order; spacings in metres.
SampledScan sample_scan(std::span<const Eigen::Vector3d> points_in_scan, double fine_spacing, double coarse_spacing,
                        const RangeLimits& limits);

}  // namespace vdbmap::registration
