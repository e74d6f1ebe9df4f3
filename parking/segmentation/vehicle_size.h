// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "parking/segmentation/surface_class.h"
#include "vdbmap/core/voxel_level.h"

namespace vdbmap::parking {

/// Gives voxels of vehicles that cannot be one the class that came second: groups of them, no more than 0.6 m apart on
/// each axis, that are shorter than 1.5 m on the ground or higher than 4.5 m. Classes are in the order of the level's
/// records.
void drop_what_is_no_vehicle(const VoxelLevel& level, std::span<const SurfaceClass> second,
                             std::vector<SurfaceClass>& classes);

}  // namespace vdbmap::parking
