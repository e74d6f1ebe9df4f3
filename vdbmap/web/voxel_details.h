// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "vdbmap/web/tile_points.h"

namespace vdbmap {

/// Size of what a file of details has of one voxel [bytes].
inline constexpr std::size_t kDetailBytes = 44;

/// What is shown of a voxel when it is picked, for all points of a tile in their order, little endian: uint32 count,
/// 3 float32 mean from the voxel's lowest corner [m], 6 float32 covariance xx yy zz xy xz yz [m^2], code of the label,
/// and the normal in three signed bytes, 127 being 1.
std::string details_of(const TileLevel& source, std::span<const TileBlock> blocks);

}  // namespace vdbmap
