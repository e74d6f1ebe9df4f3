// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "parking/ground_plan.h"
#include "parking/objects/vehicles.h"
#include "parking/occupancy/space_evidence.h"
#include "parking/segmentation/network_weights.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/core/posed_cloud.h"
#include "vdbmap/core/visibility.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap::parking {

/// What a later epoch says of spaces, and what stands there.
struct EpochEvidence {
  std::vector<SpaceEvidence> spaces;
  std::vector<Vehicle> vehicles;
};

/// Collects a drive of localized scans. All its points near the spaces make one map, whose voxels the network labels:
/// of all scans together more can be told than of one. Keeps references.
class DriveEvidence {
 public:
  /// `map` is the labelled one that the spaces are of, with a level of 0.1 m, and `ground` its ground. Throws
  /// std::invalid_argument where it has no such level.
  DriveEvidence(const VoxelMap& map, std::span<const ParkingSpace> spaces, const GroundPlan& ground);
  ~DriveEvidence();

  /// The next scan. Throws std::invalid_argument as rays_of() does.
  void add(const PosedCloud& scan);

  /// Points that were kept: near spaces.
  std::size_t num_points() const;

  /// The map of the drive, labelled, and what it says. Without points near the spaces a map without voxels, and nothing
  /// is known of any space.
  std::pair<VoxelMap, EpochEvidence> finish(const NetworkWeights& network);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What the finest level of a labelled map of a later epoch says; without visibility no space is seen to be vacant.
/// `before` is the level of the map that the spaces are of, and `ground` its ground. Throws std::invalid_argument where
/// a level has no labels or the voxel sizes differ.
EpochEvidence evidence_of_level(std::span<const ParkingSpace> spaces, const GroundPlan& ground,
                                const VoxelLevel& before, const VoxelLevel& level,
                                const std::optional<Visibility>& visibility);

}  // namespace vdbmap::parking
