// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "vdbmap/store/city_manifest.h"

/// Where things are in the folder of a city:
///
///     map.json               the manifest: what the city is now
///     epochs/N.json          what it was in epoch N
///     tiles/X_Y.HASH.vdb     tiles of all epochs, by their content
///     parts/HASH.part        sums of sources of all epochs, by their content; where the city keeps them
///     cache/                 what readers computed of tiles and may lose (tile_cache.h)
///     lock                   who writes
namespace vdbmap {

/// A city as one manifest says, for reading.
struct City {
  std::filesystem::path folder;
  std::optional<std::int32_t> epoch;  ///< that was asked for; nothing: the latest
  CityManifest manifest;
};

std::filesystem::path manifest_path(const std::filesystem::path& folder);
std::filesystem::path epochs_path(const std::filesystem::path& folder);
std::filesystem::path epoch_path(const std::filesystem::path& folder, std::int32_t epoch);
std::filesystem::path tiles_path(const std::filesystem::path& folder);
std::filesystem::path cache_path(const std::filesystem::path& folder);
std::filesystem::path kept_parts_path(const std::filesystem::path& folder);
std::filesystem::path kept_part_path(const std::filesystem::path& folder, const CityPart& part);
std::filesystem::path tile_path(const std::filesystem::path& folder, const CityTile& tile);

/// Name of a tile's file without its hash: "3_-12".
std::string tile_name(const TileId& tile);

/// Name of a tile's file: "3_-12.HASH.vdb".
std::string tile_file_name(const CityTile& tile);

/// What tells the state of a city from others: the hash of its manifest; empty where there is no city.
std::string city_state(const std::filesystem::path& folder);

/// Whether a path names a folder, "city" or "city/", or an epoch of one, "city@1". Maps in one piece are files.
bool is_city(const std::filesystem::path& path);

/// Opens a city in its latest epoch or, as "city@1", in another. Throws IoError: malformed for a folder that is no
/// city, a damaged or newer manifest, and an epoch that is not kept.
City open_city(const std::filesystem::path& path);

/// Reads the manifest again; says whether it is another than before.
bool reopen(City& city);

/// The earlier epochs that a city keeps, rising. Throws IoError (system).
std::vector<std::int32_t> list_epochs(const std::filesystem::path& folder);

/// The manifests that a city keeps, by their epoch, the latest last. Throws IoError.
std::map<std::int32_t, CityManifest> read_epochs(const std::filesystem::path& folder);

}  // namespace vdbmap
