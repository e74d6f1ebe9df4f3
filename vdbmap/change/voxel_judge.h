// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "vdbmap/change/map_diff.h"
#include "vdbmap/change/placement.h"
#include "vdbmap/change/surface_comparison.h"
#include "vdbmap/core/visibility.h"
#include "vdbmap/core/voxel_level.h"

namespace vdbmap {

/// What a voxel of one map is to another map.
struct Judgement {
  Change change = Change::kUnchanged;  ///< kAppeared: the other map saw it empty, whichever is the later
  double confidence = 1;
};

/// Judges the voxels of one map, the subject, by another; the rules are those of map_diff(). One per task; keeps
/// references to all.
class VoxelJudge {
 public:
  VoxelJudge(const SeenMap& subject, const SeenMap& other, const Placement& placement, const SignificanceLimits& limits,
             bool takes_unseen_as_empty);

  /// The record of the other map in the same place, or nullptr.
  const VoxelRecord* counterpart(const VoxelIndex& other) const { return other_finder_.find(other); }

  Judgement judge(const VoxelIndex& voxel, std::size_t record) const;

 private:
  LocalSurface around_in_subject(const VoxelIndex& voxel, const VoxelIndex& other) const;
  PointSums sums_around_in_other(const VoxelIndex& other) const;
  Distance distance_from_nearest(const VoxelIndex& other, const LocalSurface& voxel) const;
  bool is_evidently_same(const VoxelRecord& a, const VoxelRecord& b, const Eigen::Vector3d& apart) const;
  bool is_transient(std::size_t record) const;
  bool has_porous_around(const VoxelIndex& other) const;
  bool is_known(const VoxelIndex& other) const;
  double known_share(const VoxelIndex& other) const;
  bool is_seen_through(const VoxelIndex& other, const LocalSurface& around, double share) const;
  Judgement judge_unexplained(const VoxelIndex& other, std::size_t record, const LocalSurface& around,
                              const Distance* distance) const;

  const VoxelLevel& subject_;
  const Visibility* subject_visibility_;
  VoxelFinder subject_finder_;
  VoxelFinder other_finder_;
  const VoxelTree* other_seen_empty_;  ///< nullptr: nothing known
  const Placement& placement_;
  const SignificanceLimits& limits_;
  bool takes_unseen_as_empty_;
  double voxel_size_;
};

}  // namespace vdbmap
