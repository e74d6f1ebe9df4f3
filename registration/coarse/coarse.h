// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "registration/coarse/consensus.h"
#include "registration/coarse/fpfh.h"
#include "registration/coarse/map_parts.h"
#include "registration/coarse/pose_fit.h"
#include "registration/coarse/surface_points.h"
#include "vdbmap/core/voxel_level.h"
#include "vdbmap/store/map_windows.h"

namespace vdbmap::registration {

/// How a combined scan is looked for in a map without a first guess.
struct CoarseOptions {
  double feature_radius = 5;           ///< [m] of the neighbourhood that a feature describes, at most 32 voxels
  double orientation_radius = 7;       ///< [m] of the surroundings that tell a normal's side, at most 32 voxels
  std::size_t num_keypoints = 1500;    ///< most distinctive features of the scan that are matched
  double map_share = 0.35;             ///< of the map's features, the most distinctive ones, that can be matched
  int num_nearest = 3;                 ///< features of the map considered for each of the scan
  std::size_t max_whole = 8000;        ///< features to match of a map that is searched as one; a larger one in parts
  std::size_t max_part_matches = 500;  ///< of each part; as ConsensusOptions::max_matches of a map searched as one
  ConsensusOptions consensus;

  /// Throws std::invalid_argument naming the value and what is allowed.
  void check() const;
};

/// What the coarse search needs of a map's coarse level; made once and used for every scan.
struct CoarseMap {
  SurfacePoints points;
  FpfhMatrix features;
  Eigen::VectorXf mean;               ///< of the features
  Eigen::VectorXf deviation;          ///< of the features, bin by bin
  std::vector<std::uint32_t> chosen;  ///< features that can be matched

  // Of a map that is searched in parts; else nothing.
  std::vector<TileFeatures> tiles;  ///< the chosen ones
  std::vector<MapPart> parts;
  VoxelNumbers voxels;
};

/// Throws std::invalid_argument for bad options.
CoarseMap prepare_coarse_map(const VoxelLevel& level, const CoarseOptions& options = {});

/// The same of the coarsest level of a map; of a city with the features that are kept in its folder (level_features.h).
CoarseMap prepare_coarse_map(const MapWindows& map, const CoarseOptions& options = {});

/// Poses in which the combined scan may lie in the map, the best supported first (Mortazavi 2023, section 2.3); the
/// frames are the local ones of both levels, which have voxels of the same size. A large map is searched in parts, as
/// of a whole city's features most of the nearest to any lie elsewhere; there the best are those in which the scan's
/// surfaces lie best (pose_fit.h), as of thousands of poses some have many matches by chance. Empty where no three
/// features agree. The same for any number of threads.
std::vector<PoseHypothesis> find_coarse(const VoxelLevel& combined, const CoarseMap& map,
                                        const CoarseOptions& options = {});

}  // namespace vdbmap::registration
