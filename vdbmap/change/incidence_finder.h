// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "vdbmap/core/voxel_map.h"

namespace vdbmap {

/// Finds how steeply a ray meets the surface at a point, by the normals of all levels that know a flat one there. One
/// per task.
class IncidenceFinder {
 public:
  /// Planarity from which a normal counts as known: at the edge of a plane a third is left.
  static constexpr double kMinPlanarity = 0.3;

  explicit IncidenceFinder(const VoxelMap& map) {
    for (const VoxelLevel& level : map.levels) {
      finders_.emplace_back(level);
      per_metre_.push_back(voxels_per_metre(level.voxel_size()));
    }
  }

  /// The sine of the least angle between a direction, unit, and the surfaces at an addressable point [m, local frame];
  /// nothing where no level knows one. The least, as a few points can lie on a plane of their own in a road.
  std::optional<double> sine_of_incidence(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const {
    std::optional<double> least;
    for (std::size_t i = 0; i < finders_.size(); ++i) {
      const VoxelRecord* record = finders_[i].find(voxel_of_point(point, per_metre_[i]));
      if (!record || planarity_of(*record) < kMinPlanarity) continue;
      least = std::min(least.value_or(1), std::abs(normal_of(*record).dot(direction)));
    }
    return least;
  }

 private:
  std::vector<VoxelFinder> finders_;
  std::vector<double> per_metre_;
};

}  // namespace vdbmap
