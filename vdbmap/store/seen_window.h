// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

#include "vdbmap/change/map_diff.h"
#include "vdbmap/core/visibility.h"
#include "vdbmap/core/voxel_map.h"
#include "vdbmap/store/city_window.h"

namespace vdbmap {

/// A map, or a window of a city, and what rays saw of it where that is known.
struct LoadedMap {
  VoxelMap map;
  std::optional<Visibility> visibility;

  SeenMap seen() const { return {map, visibility ? &*visibility : nullptr}; }
};

/// load_map() and load_visibility() of a file.
LoadedMap load_seen_map(const std::filesystem::path& path);

/// As load_window(), with what rays saw of the tiles; nothing where no tile says it. Throws IoError as load_window()
/// does, and where the city is changed meanwhile.
LoadedMap load_seen_window(City& city, const TileChoice& is_wanted);

/// A map file, or a whole city.
LoadedMap load_seen_map_or_city(const std::filesystem::path& path);

}  // namespace vdbmap
