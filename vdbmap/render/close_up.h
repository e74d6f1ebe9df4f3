// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "vdbmap/change/change_regions.h"
#include "vdbmap/change/map_diff.h"
#include "vdbmap/core/voxel_map.h"
#include "vdbmap/render/camera.h"
#include "vdbmap/render/image.h"

namespace vdbmap {

/// The place of a region before and after, seen from one eye.
struct CloseUps {
  Image before;
  Image after;
};

/// Looks at a region from above, from where least of both maps hides it. Voxels have the colours of their points where
/// the maps have them, but what vanished is red in the picture before, what appeared green in the one after.
CloseUps draw_close_ups(const VoxelMap& earlier, const VoxelMap& later, const MapDiff& diff, const ChangeRegion& region,
                        const ImageSize& size);

}  // namespace vdbmap
