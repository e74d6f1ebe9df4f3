// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "vdbmap/change/map_update.h"
#include "vdbmap/store/city_folder.h"

namespace vdbmap {

/// How a city is brought up to date.
struct CityUpdateOptions {
  UpdateOptions update;  ///< its epoch is that of the city afterwards; default: one more than the city's
  std::string date;      ///< of the epoch, ISO 8601; empty where nobody says
  std::size_t memory_bytes = std::size_t{2} << 30;                    ///< scans not counted
  std::size_t keep_epochs = std::numeric_limits<std::size_t>::max();  ///< the latest, 1 or more

  /// Says, once all clouds were seen, whose numbers their labels are; may throw where that does not go with the
  /// city's.
  std::function<LabelScheme(LabelScheme of_city)> label_scheme = [](LabelScheme of_city) { return of_city; };
  /// Called with the result before it is published; may throw, and nothing was changed.
  std::function<void(const UpdateCounts&)> check = [](const UpdateCounts&) {};
  std::function<void(std::size_t num_tiles)> on_tiles_begun = [](std::size_t) {};
  std::function<void()> on_tile_done = [] {};  ///< called by any thread
};

/// A city after a drive.
struct UpdatedCity {
  CityManifest manifest;
  UpdateCounts counts;
  std::size_t num_renewed = 0;  ///< tiles made anew; the others keep their files
};

/// Brings a city up to date as update_map() does a map: voxels, counts and what rays saw are those of one map that is
/// updated by the same clouds, whatever the memory and the number of threads. Tiles that rays or points entered are
/// read, those beside them too where what is in a margin of theirs decides about them; all others keep their files
/// unread, unless points have an attribute that the city had not: then all are made anew. `sources` are those of the
/// clouds. The epoch before stays readable as it was.
///
/// In `output`, another folder, the city is made as it is afterwards, of that epoch alone, and `city` stays as it is;
/// where both are the same folder, it changes at once when all is done, and until then is as before, whatever happens.
///
/// Clouds are gone through twice. Throws std::invalid_argument for bad options, an epoch before the city's, sources
/// that it counted already and an epoch of a city that is past; std::out_of_range as MapBuilder::add(); IoError where a
/// tile cannot be read, another process writes, or the disk is full.
UpdatedCity update_city(const std::filesystem::path& city, const std::filesystem::path& output,
                        const CloudSource& clouds, const std::vector<MapSource>& sources,
                        const CityUpdateOptions& options = {});

/// The epoch of an update where none is given: one more than the city's. Throws std::invalid_argument for one before
/// the city's.
std::int32_t epoch_after(const CityManifest& manifest, const std::optional<std::int32_t>& wanted);

}  // namespace vdbmap
