// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "vdbmap/core/map_builder.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap::test {

/// Some hundred voxels of 10 cm and their 1 m level on both sides of every axis, several points each, with colour,
/// intensity and epochs, anchored in UTM zone 32.
VoxelMap sample_map();

/// The same points without anything but positions.
VoxelMap sample_map_without_attributes();

/// A place in Hannover (EPSG:25832) whose coordinates are whole multiples of 1024 m.
inline const Eigen::Vector3d kUtm(548'864, 5'804'032, 0);

/// The usual options with an anchor.
BuildOptions anchored(const Eigen::Vector3d& anchor);

/// The level of 10 cm alone, anchored at (0, 0, 0).
VoxelMap fine_map_of(const PointCloud& cloud);

/// One point in the middle of each voxel of 10 cm, anchored at the origin.
VoxelMap map_of_voxels(const std::vector<VoxelIndex>& voxels);

/// The 1 m level of a cloud, anchored at the origin.
VoxelLevel coarse_level(const PointCloud& cloud);

/// Whether two levels have the same voxels occupied.
bool same_voxels(const VoxelLevel& a, const VoxelLevel& b);

/// What differs first between two maps, down to the bits of every record; empty where they are equal.
std::string difference(const VoxelMap& a, const VoxelMap& b);

}  // namespace vdbmap::test
