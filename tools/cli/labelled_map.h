// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "vdbmap/core/voxel_map.h"
#include "vdbmap/store/city_window.h"
#include "vdbmap/store/seen_window.h"

namespace vdbmap::cli {

/// A map, or all of a city, whose voxels have SemanticKITTI's labels. Throws IoError as load_map_or_city() does, and
/// (malformed) where it has none.
VoxelMap load_labelled_map(const std::filesystem::path& path);

/// The same with what rays saw, where that is known; of a city the tiles that `is_wanted`, which is told the frame of
/// the map, chooses.
LoadedMap load_seen_labelled_map(const std::filesystem::path& path,
                                 const std::function<TileChoice(const MapFrame& frame)>& is_wanted);

/// The date of the latest epoch of a map, or of the epoch of a city, where it is known; else empty.
std::string date_of_map(const std::filesystem::path& path);

}  // namespace vdbmap::cli
