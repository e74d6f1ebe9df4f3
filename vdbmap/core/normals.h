// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "vdbmap/core/voxel_level.h"

namespace vdbmap {

/// Sets normal and planarity of every voxel from the merged moments of its 3x3x3 neighbourhood, exactly the moments of
/// all points in the 27 voxels. Below three points there is no plane: planarity 0, normal +z.
void compute_normals(VoxelLevel& level);

}  // namespace vdbmap
