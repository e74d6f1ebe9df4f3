// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vdbmap/change/map_diff.h"
#include "vdbmap/core/plan_rectangle.h"

namespace vdbmap {

/// A thing that appeared, vanished or changed.
struct ChangeRegion {
  std::size_t id = 0;  ///< from 1 on, the largest first
  Change kind = Change::kChanged;
  PlanRectangle plan;  ///< [m, original system] around its voxels
  double bottom = 0;   ///< [m, original system]
  double top = 0;      ///< [m, original system]
  double volume = 0;   ///< [m^3] of its voxels: surfaces, not what they enclose
  std::size_t num_voxels = 0;
  std::int32_t label = 0;  ///< of most of its voxels that have one, else kNoLabel
  double confidence = 0;   ///< mean of its voxels

  /// Middle of the box, and its sides: length, width, height [m].
  Eigen::Vector3d center() const { return {plan.center.x(), plan.center.y(), (bottom + top) / 2}; }
  Eigen::Vector3d size() const { return {plan.length, plan.width, top - bottom}; }
};

struct RegionOptions {
  double reach = 0.45;         ///< [m] voxels of a region are at most so far from the next, on each axis
  double least_volume = 0.02;  ///< [m^3] of the voxels of a region; what is smaller is none

  /// Throws std::invalid_argument naming the value and what is allowed.
  void check() const;
};

/// The regions of a diff, the largest first. Kinds are grouped each by itself: where one car left and another came, two
/// regions lie in one place.
std::vector<ChangeRegion> find_regions(const MapDiff& diff, const RegionOptions& options = {});

}  // namespace vdbmap
