// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <string_view>

#include <Eigen/Core>
#include <openvdb/math/Coord.h>

/// The one vocabulary of space: points, voxels, parents and tiles. Voxel (i,j,k) of size s covers [i s, (i+1) s) on
/// each axis of the map's local frame. Every other place that needs such a conversion calls these functions.
namespace vdbmap {

using VoxelIndex = openvdb::math::Coord;

/// Edge of a tile [m]; anchors are whole multiples of it, and it is a whole number of leaves, of 8 voxels, at every
/// voxel size: another anchor moves whole leaves.
inline constexpr double kTileSize = 64.0;

/// Indices run over [-kIndexLimit, kIndexLimit) on each axis: 21 bits, +-104 km at 10 cm.
inline constexpr std::int32_t kIndexLimit = 1 << 20;

/// The voxel that holds `point` [m, local frame]. The caller has checked is_addressable().
inline VoxelIndex voxel_of_point(const Eigen::Vector3d& point, double voxels_per_metre) {
  return {static_cast<std::int32_t>(std::floor(point.x() * voxels_per_metre)),
          static_cast<std::int32_t>(std::floor(point.y() * voxels_per_metre)),
          static_cast<std::int32_t>(std::floor(point.z() * voxels_per_metre))};
}

/// Whether `point` [m, local frame] is finite and lies in a voxel whose index has 21 bits.
inline bool is_addressable(const Eigen::Vector3d& point, double voxels_per_metre) {
  const double limit = kIndexLimit;
  const Eigen::Array3d scaled = point.array() * voxels_per_metre;
  return (scaled >= -limit).all() && (scaled < limit).all();
}

/// Corner of the voxel with the smallest coordinates [m, local frame].
inline Eigen::Vector3d corner_of_voxel(const VoxelIndex& voxel, double voxel_size) {
  return Eigen::Vector3d(voxel.x(), voxel.y(), voxel.z()) * voxel_size;
}

/// Centre of the voxel [m, local frame].
inline Eigen::Vector3d center_of_voxel(const VoxelIndex& voxel, double voxel_size) {
  return Eigen::Vector3d(voxel.x() + 0.5, voxel.y() + 0.5, voxel.z() + 0.5) * voxel_size;
}

/// Largest whole number not above dividend / divisor, for divisor > 0.
inline std::int32_t floor_divide(std::int32_t dividend, std::int32_t divisor) {
  return dividend >= 0 ? dividend / divisor : -((-dividend + divisor - 1) / divisor);
}

/// The voxel of the level above that holds `voxel`; a parent's edge is `factor` voxels long.
inline VoxelIndex parent_of_voxel(const VoxelIndex& voxel, std::int32_t factor) {
  return {floor_divide(voxel.x(), factor), floor_divide(voxel.y(), factor), floor_divide(voxel.z(), factor)};
}

/// The lowest of the voxels that a voxel of the level above covers.
inline VoxelIndex first_child_of_voxel(const VoxelIndex& parent, std::int32_t factor) {
  return {parent.x() * factor, parent.y() * factor, parent.z() * factor};
}

/// Whether the index has 21 bits on each axis.
inline bool is_addressable(const VoxelIndex& voxel) {
  const auto inside = [](std::int32_t i) { return i >= -kIndexLimit && i < kIndexLimit; };
  return inside(voxel.x()) && inside(voxel.y()) && inside(voxel.z());
}

/// What is expected of a voxel size, for messages.
inline constexpr std::string_view kAllowedVoxelSizes =
    "expected 0.001 to 8 m that divide 8 m, like 0.05, 0.1, 0.2, 0.5, 1, 2";

/// Number of voxels along one metre. Throws std::invalid_argument unless the size is at least 0.001 m and a tile of 64
/// m is, to 1e-9, a multiple of 8 voxels long: 8 m are a whole number of them.
double voxels_per_metre(double voxel_size);

/// Edge of a voxel of the level above in voxels of the level below. Throws std::invalid_argument unless it is a whole
/// number from 2 on.
std::int32_t level_factor(double fine_voxel_size, double coarse_voxel_size);

}  // namespace vdbmap
