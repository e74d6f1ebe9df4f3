// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/store/city_manifest.h"

namespace vdbmap {

/// Writes a map as a city, in a folder that is new, empty or what is left of a city that was not finished. Loaded as a
/// whole, the city is that map again, bit for bit. Its epoch is the latest that a voxel was seen in. Throws IoError,
/// also where the folder holds a city already.
CityManifest save_city(const std::filesystem::path& folder, const VoxelMap& map, const SaveOptions& options = {},
                       const std::vector<MapSource>& sources = {});

/// The same with what is known beside the voxels: tiles then say what rays saw, also those without a voxel.
CityManifest save_city(const std::filesystem::path& folder, const VoxelMap& map, const MapExtras& extras,
                       const SaveOptions& options = {});

}  // namespace vdbmap
