// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vdbmap {

/// One epoch of a site: a map file, a city, or an epoch of one ("city@1").
struct SiteEpoch {
  std::filesystem::path map;
  std::string name;  ///< as it is shown where nothing better is known; empty: its number
};

struct SiteOptions {
  std::string name;                           ///< of the site, as it is shown
  std::vector<std::string> epoch_names;       ///< as they are shown; empty: dates of spaces, names of maps
  std::filesystem::path diff;                 ///< of the last two epochs (.vdb); empty: changes are not shown
  std::vector<std::filesystem::path> spaces;  ///< GeoJSON of parking spaces, a file an epoch; see read_site_spaces()
  double geoid_offset = 0;                    ///< [m] see GeodeticTransform
  std::filesystem::path page;                 ///< folder of the built page, copied into the site; empty: the data alone
  std::function<void(std::size_t num_blocks)> on_tiles_begun = [](std::size_t) {};
  std::function<void()> on_block_done = [] {};
};

/// What was written.
struct SiteWritten {
  std::uint64_t num_voxels = 0;       ///< of the finest levels of all epochs
  std::uint64_t num_drawn = 0;        ///< of these: those that can be seen
  std::uint64_t num_tiles = 0;        ///< of all levels and epochs
  std::uint64_t num_tile_bytes = 0;   ///< of the files of all tiles
  std::size_t num_files_written = 0;  ///< of tiles and details
  std::size_t num_files_kept = 0;     ///< of these, taken over from the site that was there
  std::size_t num_spaces = 0;         ///< that are shown
  bool is_on_globe = false;
};

/// Writes maps as a site: tiles (OGC 3D Tiles 1.1) of every epoch, from the earliest to the latest, what is shown of
/// picked voxels, what changed, parking spaces, and the page. A diff marks the voxels of the last epoch, and adds to it
/// those that vanished: as the epoch before has them, else in the colour of the diff. Files of spaces are those of the
/// latest epochs; where there are more of them than maps, the last map stands for the later epochs too, which are
/// called by the dates of their files. The folder appears whole; a site that was there is replaced, and files of equal
/// content are taken over from it. Equal maps give equal bytes, for any number of threads.
///
/// Throws std::invalid_argument without epochs, with names of another number of them, where their anchors, EPSG codes,
/// voxel sizes or label schemes differ and for EPSG codes that PROJ does not know; IoError for maps, diffs and spaces
/// that cannot be read, maps without voxels, diffs and spaces of another place, and for a folder that cannot be written
/// or holds something else.
SiteWritten write_site(const std::filesystem::path& folder, const std::vector<SiteEpoch>& epochs,
                       const SiteOptions& options);

/// A city in all epochs that it keeps, as paths "city@1"; other paths as they are. Throws IoError.
std::vector<std::filesystem::path> epochs_of(const std::filesystem::path& path);

}  // namespace vdbmap
