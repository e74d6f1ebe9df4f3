// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/map_window.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vdbmap::registration {
namespace {

constexpr double kMaxMotion = 8;     // [m] of an alignment: kernels reach 3 m
constexpr double kSearchVoxels = 3;  // of the coarsest level, around a point

}  // namespace

std::shared_ptr<const VoxelMap> window_of(const MapWindows& map, std::span<const Eigen::Vector3d> points,
                                          const Eigen::Isometry3d& map_from_points) {
  if (points.empty()) return map.around(map_from_points.translation(), 0);
  Eigen::Vector3d low = points.front();
  Eigen::Vector3d high = points.front();
  for (const Eigen::Vector3d& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const Eigen::Vector3d middle = (low + high) / 2;
  double squared_radius = 0;
  for (const Eigen::Vector3d& point : points) squared_radius = std::max(squared_radius, (point - middle).squaredNorm());
  const std::vector<double> sizes = map.voxel_sizes();
  const double reach = kMaxMotion + (sizes.empty() ? 0 : kSearchVoxels * sizes.back());
  return map.around(map_from_points * middle, std::sqrt(squared_radius) + reach);
}

}  // namespace vdbmap::registration
