// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "vdbmap/change/ray_evidence.h"
#include "vdbmap/core/posed_cloud.h"
#include "vdbmap/core/visibility.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap {

/// What the rays of the clouds that a map was built of say of it: the hits of a voxel are its points.
Visibility find_visibility(const VoxelMap& map, const CloudSource& clouds, const RayTrust& trust = {});

}  // namespace vdbmap
