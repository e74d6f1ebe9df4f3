// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "vdbmap/core/posed_cloud.h"
#include "vdbmap/io/map_from_files.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/store/city_manifest.h"

namespace vdbmap {

/// A source of a city that another takes the place of, after its trajectory was corrected for example.
struct SourceReplacement {
  std::string source;  ///< name or hash
  MapInput input;      ///< counted in the epoch of that source
};

/// How a city is built.
struct CityBuildOptions {
  MapFromFilesOptions files;
  SaveOptions save;
  std::size_t memory_bytes = std::size_t{2} << 30;  ///< that the build may take, files of points not counted
  bool keeps_parts = false;  ///< the sums of each source stay: what is changed later is then exact. In a city that has
                             ///< them, they always stay
  std::vector<std::string> removed;                                   ///< sources of the city that go, by name or hash
  std::vector<SourceReplacement> replaced;                            ///< and of which others take the place
  std::size_t keep_epochs = std::numeric_limits<std::size_t>::max();  ///< the latest, 1 or more
  std::string date;  ///< of the epoch, ISO 8601; empty where nobody says
  /// The points of inputs with the rays by which they were measured; without, of rays nothing is known.
  std::function<void(const std::vector<MapInput>& counted, const std::function<void(const PosedCloud&)>& take)> rays;
  std::function<void()> on_file_hashed = [] {};  ///< called by any thread
  std::function<void(std::size_t num_scans)> on_reading_begun = [](std::size_t) {};
  std::function<void(std::size_t num_tiles)> on_tiles_begun = [](std::size_t) {};
  std::function<void()> on_tile_done = [] {};  ///< called by any thread
};

/// What became of the inputs.
struct CityBuilt {
  CityManifest manifest;
  InputNotes notes;                         ///< of the sources that were counted now
  std::vector<MapSource> added;             ///< these
  std::vector<std::string> not_counted;     ///< names of inputs that are in the city already, or twice among the inputs
  std::vector<MapSource> removed = {};      ///< sources that are in the city no more
  std::vector<std::string> not_found = {};  ///< what was to be removed and is no source of the city
};

/// Makes a city of the points of files. Its tiles are those of the map that build_map_from_files() makes of the inputs
/// in the order of their names, byte for byte, for any memory, number of threads and order of the inputs. Without an
/// anchor it is that of the first of them by name. A city that is there already is replaced where all of its sources
/// are among the inputs. With rays, what they saw is that of find_visibility(). Throws as build_map_from_files() does,
/// std::invalid_argument where a city of other sources is there, and IoError where the folder cannot be written or is
/// another's; the folder is then as it was.
CityBuilt build_city(const std::filesystem::path& folder, const std::vector<MapInput>& inputs,
                     const CityBuildOptions& options);

/// Adds the points of files to a city, whose anchor and levels it keeps, and takes sources out or replaces them.
///
/// Of a city that keeps parts the tiles are then those of build_city() of the sources that it has now, with its anchor,
/// density and the epochs of its manifest, byte for byte; where inputs or options need parts and the city has none,
/// std::invalid_argument says so. Without parts they are those of merge_maps() of the city and the map of the new
/// sources: exact to the stored precision.
///
/// Sources that are counted already are left out; where that is all of them,
/// and none is removed, nothing changes. The epoch of new points is that of the options or, without, the city's. Throws
/// as build_city(), and std::invalid_argument for an epoch before the city's and for levels other than the city's.
CityBuilt add_to_city(const std::filesystem::path& folder, const std::vector<MapInput>& inputs,
                      const CityBuildOptions& options);

}  // namespace vdbmap
