// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "vdbmap/change/map_diff.h"
#include "vdbmap/core/voxel_level.h"

namespace vdbmap {

/// The voxels of a diff as one level whose labels are Change; those that were not observed have empty records.
VoxelLevel change_marks(const MapDiff& diff);

}  // namespace vdbmap
