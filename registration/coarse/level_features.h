// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "registration/coarse/fpfh.h"
#include "registration/coarse/surface_points.h"
#include "vdbmap/core/voxel_level.h"
#include "vdbmap/store/map_windows.h"

namespace vdbmap::registration {

/// How far features look.
struct FeatureReach {
  double orientation_radius = 7;  ///< [m] as of surface_points()
  double feature_radius = 5;      ///< [m] as of fpfh_features()
};

/// One oriented point with its feature for each voxel of a level.
struct LevelFeatures {
  SurfacePoints points;
  FpfhMatrix features;
};

LevelFeatures features_of_level(const VoxelLevel& level, const FeatureReach& reach);

/// Those of the coarsest level of a map. Of a city, what was computed of a tile with the same tiles around it before is
/// read from its folder, where the rest is kept (store/tile_cache.h): the same bit for bit.
LevelFeatures features_of_map(const MapWindows& map, const FeatureReach& reach);

}  // namespace vdbmap::registration
