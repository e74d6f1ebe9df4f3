// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "vdbmap/core/voxel_level.h"

namespace vdbmap {

/// The faces of a voxel behind which there is no voxel of its level, one a bit: 0 to 5 are -x +x -y +y -z +z.
using AirFaces = std::uint8_t;

/// The faces of every voxel of a level, in the order of its records; 0: the voxel cannot be seen from anywhere.
std::vector<AirFaces> air_faces(const VoxelLevel& level);

}  // namespace vdbmap
