// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vdbmap/core/eigen_features.h"
#include "vdbmap/core/point_cloud.h"
#include "vdbmap/core/voxel_id.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap {

/// Everything a map knows of one voxel, decoded.
struct VoxelInfo {
  VoxelId id{};
  VoxelIndex index;
  double voxel_size = 0;  ///< [m] edge
  std::uint32_t count = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();        ///< [m, original system]
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< [m^2] of the voxel's own points, divisor n-1
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();     ///< of the 3x3x3 neighbourhood: unit, z >= 0
  double planarity = 0;                                  ///< of the 3x3x3 neighbourhood, 0 to 1
  EigenFeatures features;                                ///< of the voxel's own covariance
  std::optional<Eigen::Vector3d> linear_color;           ///< RGB 0..1, where the map has colours
  std::optional<Rgb16> color;                            ///< the same in sRGB
  std::optional<float> intensity;                        ///< scale of the source
  std::optional<std::int32_t> label;                     ///< class, kNoLabel where no point has one
  std::string label_name;                                ///< what it stands for; empty where the map has no labels
  std::optional<std::int32_t> first_epoch;
  std::optional<std::int32_t> last_epoch;
};

/// The voxel of a level of the map that holds `point` [m, original system]; nothing where it is not occupied.
std::optional<VoxelInfo> voxel_at(const VoxelMap& map, const VoxelLevel& level, const Eigen::Vector3d& point);

/// The voxel of that id; nothing where it is not occupied.
std::optional<VoxelInfo> voxel_with_id(const VoxelMap& map, const VoxelLevel& level, VoxelId id);

/// The voxels that share a point with the closed box [m, original system], in the order of the records. Looks into the
/// leaves that touch the box only. Throws std::invalid_argument where `box.min` exceeds `box.max` or one is NaN.
std::vector<VoxelInfo> voxels_in_box(const VoxelMap& map, const VoxelLevel& level, const Extent& box);

}  // namespace vdbmap
