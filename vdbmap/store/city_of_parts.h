// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "vdbmap/store/city_build.h"
#include "vdbmap/store/city_writer.h"
#include "vdbmap/store/source_changes.h"

namespace vdbmap {

/// Counts the new sources, a part each, and publishes the city of the sources that are left and these: its tiles are
/// made of parts alone, those that no changed source comes near stay. A new city gets the anchor of its first source
/// with points. Throws as count_points() and open_kept_sources().
CityBuilt write_city_of_parts(CityWriter& writer, const std::optional<City>& base, SourceChanges changes,
                              const CityBuildOptions& options);

}  // namespace vdbmap
