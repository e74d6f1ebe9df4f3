// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "vdbmap/core/voxel_map.h"

namespace vdbmap {

/// Where the voxels of one map lie in another of the same voxel size.
class Placement {
 public:
  /// `other_from_subject` in the original system. Without a motion, voxels lie on voxels and leaves on leaves, as
  /// anchors are whole tiles.
  Placement(const MapFrame& subject, const MapFrame& other, const Eigen::Isometry3d& other_from_subject,
            double voxel_size)
      : rotation_(other_from_subject.linear()), voxel_size_(voxel_size), per_metre_(voxels_per_metre(voxel_size)) {
    is_whole_ = rotation_ == Eigen::Matrix3d::Identity() && other_from_subject.translation().isZero(0);
    local_shift_ = other_from_subject * subject.anchor - other.anchor;
    const Eigen::Array3d voxels = ((subject.anchor - other.anchor) * per_metre_).array().round();
    constexpr double kFar = 4.0 * kIndexLimit;  // no voxel of the one is one of the other
    const Eigen::Array3d limited = voxels.max(-kFar).min(kFar);
    shift_ = VoxelIndex(static_cast<std::int32_t>(limited.x()), static_cast<std::int32_t>(limited.y()),
                        static_cast<std::int32_t>(limited.z()));
  }

  /// Whether voxels lie on voxels.
  bool is_whole() const { return is_whole_; }

  /// Voxels from one frame to the other, without the motion.
  const VoxelIndex& shift() const { return shift_; }

  const Eigen::Matrix3d& rotation() const { return rotation_; }

  /// The voxel of the other map in which the mean of a voxel lies; one that cannot be addressed where there is none.
  VoxelIndex other_voxel(const VoxelIndex& voxel, const VoxelRecord& record) const {
    if (is_whole_) return voxel + shift_;
    const Eigen::Vector3d place = rotation_ * mean_of(record, voxel, voxel_size_) + local_shift_;
    return is_addressable(place, per_metre_) ? voxel_of_point(place, per_metre_) : VoxelIndex(kIndexLimit);
  }

  /// A place [m from the corner of `voxel`], seen from the corner of `other`, a voxel of the other map.
  Eigen::Vector3d seen_from(const VoxelIndex& other, const VoxelIndex& voxel, const Eigen::Vector3d& place) const {
    if (is_whole_) return place;
    const Eigen::Vector3d moved = rotation_ * (corner_of_voxel(voxel, voxel_size_) + place) + local_shift_;
    return moved - corner_of_voxel(other, voxel_size_);
  }

 private:
  Eigen::Matrix3d rotation_;
  double voxel_size_;
  double per_metre_;
  bool is_whole_;
  Eigen::Vector3d local_shift_;
  VoxelIndex shift_;
};

}  // namespace vdbmap
