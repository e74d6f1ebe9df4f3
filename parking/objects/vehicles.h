// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "parking/objects/upright_box.h"
#include "vdbmap/core/voxel_level.h"

namespace vdbmap::parking {

/// A vehicle that stands in a map.
struct Vehicle {
  UprightBox box;             ///< [m, local frame]; where one side only was seen, as wide or long as cars usually are
  bool is_completed = false;  ///< whether it was made wider or longer than what was seen
  std::size_t num_voxels = 0;
  std::uint64_t num_points = 0;
  std::string doubt;  ///< why it can hardly be a vehicle: its size; empty where nothing speaks against it
};

/// The vehicles of a level whose labels are SemanticKITTI's: groups of vehicle voxels, each voxel at most 0.5 m from
/// the next on each axis (so a car that is seen in two parts is one). What is larger than a car is cut where its
/// profile falls below a third of its height on both sides (cars that touch). Sorted by their first voxel. Throws
/// std::invalid_argument where the level has no labels.
std::vector<Vehicle> find_vehicles(const VoxelLevel& level);

}  // namespace vdbmap::parking
