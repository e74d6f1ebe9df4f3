// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "parking/objects/vehicles.h"
#include "parking/spaces/parking_space.h"
#include "vdbmap/core/voxel_level.h"

namespace vdbmap::parking {

struct FindSpacesOptions {
  std::string date;                 ///< ISO 8601, of the map; empty: not known
  std::vector<ParkingSpace> known;  ///< of earlier epochs: keep their ids and outlines
};

struct FoundSpaces {
  std::vector<ParkingSpace> spaces;  ///< known ones first, then new ones, then new candidates; each has an id
  std::size_t num_vehicles = 0;      ///< in the map
  std::vector<std::string> doubts;   ///< of vehicles that make no space
  std::size_t num_new = 0;           ///< spaces that are not among the known ones, without candidates
  std::size_t num_seen_again = 0;    ///< known spaces in which a vehicle stands
};

/// Spaces as in the paper: where vehicles stand in a labelled map (Mortazavi 2023, section 4). A vehicle that shares
/// half of its area, or of the space's, with a known space stands in it; one that shares a fifth makes no new one. Free
/// kerb between spaces that is long enough for a car is offered as candidates. Vehicles in the lane make no space. New
/// ids are numbers that no known space has, row by row. Throws std::invalid_argument where the level has no labels.
FoundSpaces find_spaces(const VoxelLevel& level, const FindSpacesOptions& options = {});

/// Two spaces that lie on each other, by their numbers, and the shared part of the smaller one's area.
struct SpaceOverlap {
  std::size_t a, b;
  double share;
};

/// All pairs that share more than a tenth.
std::vector<SpaceOverlap> find_overlaps(std::span<const ParkingSpace> spaces);

}  // namespace vdbmap::parking
