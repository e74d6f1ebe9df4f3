// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "vdbmap/core/voxel.h"

namespace vdbmap {

/// A voxel, and where in it a point lies: [0, 1) of its edge on each axis, or 1 for a point a hair below 0, which lies
/// in voxel -1 and rounds to its end.
struct PointCell {
  VoxelIndex voxel;
  Eigen::Array3d share;
};

/// Finds the voxels of points. Every step of building asks here: two expressions of the same cell, rounded differently,
/// would put a point on a border into one voxel's block and another's place.
class CellFinder {
 public:
  CellFinder(const Eigen::Isometry3d& local_from_cloud, double voxels_per_metre)
      : rotation_(local_from_cloud.linear() * voxels_per_metre),
        translation_(local_from_cloud.translation() * voxels_per_metre) {}

  /// The cell of a point of the cloud; nothing where its index does not have 21 bits, or it is not finite.
  std::optional<PointCell> find(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d scaled = scale(point);
    if (!is_addressable(scaled, 1.0)) return std::nullopt;
    return cell_at(scaled);
  }

  /// The same of a point that has a cell.
  PointCell of_reached(const Eigen::Vector3d& point) const { return cell_at(scale(point)); }

  /// Whether the point has a cell.
  bool reaches(const Eigen::Vector3d& point) const { return is_addressable(scale(point), 1.0); }

 private:
  // To where voxels have edge 1.
  Eigen::Vector3d scale(const Eigen::Vector3d& point) const { return rotation_ * point + translation_; }

  static PointCell cell_at(const Eigen::Vector3d& scaled) {
    const VoxelIndex voxel = voxel_of_point(scaled, 1.0);
    return {voxel, scaled.array() - Eigen::Array3d(voxel.x(), voxel.y(), voxel.z())};
  }

  Eigen::Matrix3d rotation_;
  Eigen::Vector3d translation_;
};

}  // namespace vdbmap
