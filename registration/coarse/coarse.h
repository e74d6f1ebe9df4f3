// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "registration/coarse/consensus.h"
#include "registration/coarse/fpfh.h"
#include "registration/coarse/surface_points.h"
#include "vdbmap/core/voxel_level.h"

namespace vdbmap::registration {

/// How a combined scan is looked for in a map without a first guess.
struct CoarseOptions {
  double feature_radius = 5;         ///< [m] of the neighbourhood that a feature describes, at most 32 voxels
  double orientation_radius = 7;     ///< [m] of the surroundings that tell a normal's side, at most 32 voxels
  std::size_t num_keypoints = 1500;  ///< most distinctive features of the scan that are matched
  double map_share = 0.35;           ///< of the map's features, the most distinctive ones, that can be matched
  int num_nearest = 3;               ///< features of the map considered for each of the scan
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
};

/// Throws std::invalid_argument for bad options.
CoarseMap prepare_coarse_map(const VoxelLevel& level, const CoarseOptions& options = {});

/// Poses in which the combined scan may lie in the map, the best supported first (Mortazavi 2023, section 2.3); the
/// frames are the local ones of both levels, which have voxels of the same size. Empty where no three features agree.
/// The same for any number of threads.
std::vector<PoseHypothesis> find_coarse(const VoxelLevel& combined, const CoarseMap& map,
                                        const CoarseOptions& options = {});

}  // namespace vdbmap::registration
