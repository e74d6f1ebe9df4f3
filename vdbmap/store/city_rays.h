// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "vdbmap/core/posed_cloud.h"
#include "vdbmap/store/city_folder.h"
#include "vdbmap/store/tile_renewal.h"

namespace vdbmap {

/// Adds to tiles what the rays say by which points were measured that were just added to a city: `made` is the city
/// with these points, `base` what it was before, if it was there, and `clouds` are the points. Of a new city it is
/// find_visibility() of the map in one piece. Returns the tiles as they are then, saved anew where they say something
/// else, and those that rays alone entered. `folder` is there and empty, for files on the way. Throws IoError.
std::vector<CityTile> add_rays_to_tiles(const City& made, const std::optional<City>& base, const CloudSource& clouds,
                                        std::size_t memory_bytes, const std::filesystem::path& folder,
                                        const SaveTile& save);

}  // namespace vdbmap
