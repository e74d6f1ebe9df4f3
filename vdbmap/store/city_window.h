// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "vdbmap/core/voxel_map.h"
#include "vdbmap/store/city_folder.h"

namespace vdbmap {

/// Says whether a tile is to be loaded.
using TileChoice = std::function<bool(const CityTile&)>;

/// The chosen tiles of a city as one map: their leaves and records are copied, nothing is computed. A city without such
/// a tile gives a map without voxels. A writer may replace the manifest and its tiles at any time: where a tile is
/// gone, the manifest is read again and all of the window with it, so that the map is of one state. Throws IoError
/// naming the tile that is missing, damaged or not the manifest's.
VoxelMap load_window(City& city, const TileChoice& is_wanted);

/// As load_window(), but the finest level is not read: it has no voxels.
VoxelMap load_coarser_window(City& city, const TileChoice& is_wanted);

/// All tiles.
VoxelMap load_city(City& city);

/// A map file, or a whole city as load_city() gives it.
VoxelMap load_map_or_city(const std::filesystem::path& path);

/// Tiles that have a point in common with the box [m, original system]; its heights do not count.
TileChoice tiles_in_box(const Extent& box);

/// A tile of a city; nothing where its file is missing. Throws IoError as load_window().
std::optional<VoxelMap> load_tile(const City& city, const CityTile& tile);

/// The same of a state that no writer replaces meanwhile, as a writer has it: throws IoError where the file is missing.
VoxelMap load_present_tile(const City& city, const CityTile& tile);

/// Why a map is not what the manifest says of this tile; empty where it is.
std::string tile_problem(const VoxelMap& map, const CityTile& tile, const CityLayout& layout);

}  // namespace vdbmap
