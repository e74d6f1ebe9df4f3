// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include "vdbmap/change/change_regions.h"
#include "vdbmap/change/map_diff.h"
#include "vdbmap/core/voxel_map.h"
#include "vdbmap/render/image.h"

namespace vdbmap {

/// One of two maps on a page.
struct PageMap {
  const VoxelMap& map;
  std::string name;
  std::string date;  ///< empty where it is not known
};

/// A page of 2400 pixels' width that tells people what changed: a plan with all regions outlined, the five largest of
/// them before and after side by side, a table. Regions as find_regions() orders them. The same pixels for any number
/// of threads. Throws std::invalid_argument where both maps are empty or the diff is not of the later one.
Image draw_change_page(const PageMap& earlier, const PageMap& later, const MapDiff& diff,
                       std::span<const ChangeRegion> regions);

}  // namespace vdbmap
