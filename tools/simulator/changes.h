// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "tools/simulator/street.h"
#include "vdbmap/core/voxel.h"

namespace vdbmap::simulator {

/// A voxel that surfaces pass in one of two epochs only.
struct ChangedVoxel {
  VoxelIndex voxel;      ///< of kChangeVoxelSize, from the anchor of change_anchor()
  bool has_appeared;     ///< else it has vanished
  std::uint16_t label;   ///< class of a surface in it
  std::uint16_t object;  ///< that the surface belongs to
};

inline constexpr double kChangeVoxelSize = 0.1;  // [m]

/// The anchor [m, EPSG:25832] that a map of the street takes by default, if it begins near the street's origin.
Eigen::Vector3d change_anchor(const Street& street);

/// The voxels that differ between an epoch and the next, in the order of their ids. Surfaces are sampled every two
/// centimetres: a voxel that one only just cuts can be missed.
std::vector<ChangedVoxel> changed_voxels(const Street& street, int epoch);

}  // namespace vdbmap::simulator
