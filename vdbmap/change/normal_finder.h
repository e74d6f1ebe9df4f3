// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "vdbmap/core/voxel_map.h"

namespace vdbmap {

/// Finds the normal of the surface at a point: that of the finest level that knows a flat one there. One per task.
class NormalFinder {
 public:
  /// Planarity from which a normal counts as known.
  static constexpr double kMinPlanarity = 0.5;

  explicit NormalFinder(const VoxelMap& map) {
    for (const VoxelLevel& level : map.levels) {
      finders_.emplace_back(level);
      per_metre_.push_back(voxels_per_metre(level.voxel_size()));
    }
  }

  /// The normal, unit, at an addressable point [m, local frame]; nothing where no level knows one.
  std::optional<Eigen::Vector3d> find(const Eigen::Vector3d& point) const {
    for (std::size_t i = 0; i < finders_.size(); ++i) {
      const VoxelRecord* record = finders_[i].find(voxel_of_point(point, per_metre_[i]));
      if (record && planarity_of(*record) >= kMinPlanarity) return normal_of(*record);
    }
    return std::nullopt;
  }

 private:
  std::vector<VoxelFinder> finders_;
  std::vector<double> per_metre_;
};

}  // namespace vdbmap
