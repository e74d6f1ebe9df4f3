// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parking/segmentation/network_weights.h"
#include "vdbmap/core/voxel_level.h"

namespace vdbmap::parking {

/// What the network is told of each voxel, a row each: 1; half its height [m] over the lowest mean of 5 x 5 columns of
/// 0.5 m around, from -1 to 4; the same over 17 x 17 columns; log2(points) / 6, at most 2.
Rows voxel_features(const VoxelLevel& finest);

}  // namespace vdbmap::parking
