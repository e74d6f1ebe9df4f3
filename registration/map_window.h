// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>

#include <Eigen/Geometry>

#include "vdbmap/store/map_windows.h"

namespace vdbmap::registration {

/// The part of a map that matters to points, in a frame of their own, whose pose is about this: what lies around them,
/// as far as an alignment may move them and look from there.
std::shared_ptr<const VoxelMap> window_of(const MapWindows& map, std::span<const Eigen::Vector3d> points,
                                          const Eigen::Isometry3d& map_from_points);

}  // namespace vdbmap::registration
