// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include "vdbmap/change/map_diff.h"

namespace vdbmap {

/// How maps on disk are compared.
struct StoredDiffOptions {
  DiffOptions diff;
  std::int32_t tiles_at_once = 4;  ///< along each side of a block of cities' tiles
  std::function<void(std::size_t num_done, std::size_t num_blocks)> on_block_done = [](std::size_t, std::size_t) {};
};

/// What is known of the two maps beside their diff.
struct StoredDiff {
  MapDiff diff;
  bool earlier_has_rays = false;  ///< whether the map knows what is empty
  bool later_has_rays = false;
  bool do_overlap = false;  ///< whether the boxes around their voxels have a point in common
};

/// Compares two maps, each a file or a city ("city/", "city@2"). Cities are read in blocks of tiles, each with the
/// tiles around it: memory is that of a block of each, and of what was found. Blocks whose tiles are the same files in
/// both cities are not read. Throws as map_diff(), load_map() and load_window().
StoredDiff diff_stored_maps(const std::filesystem::path& earlier, const std::filesystem::path& later,
                            const StoredDiffOptions& options = {});

}  // namespace vdbmap
