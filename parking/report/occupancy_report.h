// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "parking/ground_plan.h"
#include "parking/occupancy/occupancy_record.h"
#include "vdbmap/core/voxel_map.h"
#include "vdbmap/render/image.h"

namespace vdbmap::parking {

/// Pages of a report for people, 2480 x 1754 pixels (A4 across at 210 dots an inch): the first says how many spaces are
/// taken and what changed, with the street as a whole in plan and perspective; then the street in sections of 100 m
/// with the ids of the spaces; then tables. `map` is the labelled one that the spaces are of, `later` that of the
/// epoch, labelled, which may be empty. The same pixels for any number of threads. Throws std::invalid_argument without
/// spaces and where a map has no labels.
std::vector<Image> draw_report(const OccupancyRecord& record, const VoxelMap& map, const VoxelMap& later,
                               const GroundPlan& ground);

}  // namespace vdbmap::parking
