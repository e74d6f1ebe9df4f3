// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "vdbmap/io/map_from_files.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/store/city_folder.h"

/// What a city that is there already means for new points.
namespace vdbmap {

/// The choices that a city leaves to those who add to it: its anchor, levels and density stay, and where its voxels
/// have epochs, new points have one too. Throws std::invalid_argument for an epoch before the city's and for other
/// levels.
void fit_to_city(const City& city, MapFromFilesOptions& files, SaveOptions& save);

/// A city may be replaced by one of sources among which all of its own are: the same command again, or more of them.
/// Throws std::invalid_argument where it cannot.
void check_replaceable(const City& city, std::size_t num_epochs, const std::vector<MapSource>& sources);

/// What was learnt and made of new sources.
struct NewTiles {
  CityLayout layout;               ///< of all tiles afterwards
  std::vector<CityTile> tiles;     ///< all that are not those of the city as it was
  std::vector<MapSource> sources;  ///< counted now, of the epoch that the city is in afterwards
};

/// The manifest of a city, or of none, with new tiles and sources; `kept` are those that stay.
CityManifest manifest_with(const std::optional<City>& base, std::vector<CityTile> kept, NewTiles added,
                           std::int32_t epoch);

/// The tiles of a city that are not among `renewed`, which is sorted.
std::vector<CityTile> tiles_without(const City& base, std::span<const TileId> renewed);

}  // namespace vdbmap
