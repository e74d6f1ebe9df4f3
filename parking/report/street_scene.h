// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "parking/ground_plan.h"
#include "parking/spaces/parking_space.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap::parking {

/// A map for pictures of what stands in a street now: the labelled `map` without its vehicles and without what is more
/// than 3 m above the ground, which hides the street; what the labelled map of a later epoch has of
/// vehicles in the spaces, and its ground where the first has none. Maps without colours get some by their classes.
/// Throws std::invalid_argument where one has no labels; a later one without voxels, or with voxels of another size, is
/// left out.
VoxelMap street_scene(const VoxelMap& map, const VoxelMap& later, const GroundPlan& ground,
                      std::span<const ParkingSpace> spaces);

}  // namespace vdbmap::parking
