// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "vdbmap/core/voxel_level.h"

namespace vdbmap {

/// A level, and what became of its voxels since the epoch before.
struct MarkedLevel {
  VoxelLevel voxels;
  std::optional<VoxelLevel> marks;  ///< the same voxels; labels are Change, kNoLabel for none

  /// The level whose voxels are twice as long. A voxel is marked as most points of its marked children are.
  MarkedLevel coarsened() const;
};

/// A level with the marks of a diff, and with the voxels that vanished: those are of `before` where it has them, else
/// of the diff. Marks of voxels that are in neither do not count. Channels of what vanished are 0, but for labels of
/// `before`.
MarkedLevel with_marks(const VoxelLevel& level, const VoxelLevel& marks, const VoxelLevel* before);

}  // namespace vdbmap
