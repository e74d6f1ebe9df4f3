// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>

#include "vdbmap/core/visibility.h"
#include "vdbmap/store/city_folder.h"
#include "vdbmap/store/city_lock.h"
#include "vdbmap/store/part_file.h"

namespace vdbmap {

/// Saves a tile in a folder of tiles under the name of its content, with what rays saw of it, and counts it. Several
/// threads, but one process, may save tiles in it at a time.
CityTile save_tile(const std::filesystem::path& tiles_folder, const TileId& id, const VoxelMap& tile, float density,
                   const std::optional<Visibility>& visibility = {});

/// Throws IoError, malformed, unless size and stated checksum of a file are those of a tile. That its content has this
/// checksum is what `check` looks at.
void check_tile_file(const std::filesystem::path& path, const CityTile& tile);

/// Writes a city. What it is changes in one moment, when publish() renames the manifest: before, readers see the state
/// before, whatever tiles were saved, and a process that ends at any moment leaves that state. Tiles and parts that no
/// manifest names are removed: those of a writer that ended too early by the next one.
class CityWriter {
 public:
  /// Takes the lock of the folder, which is created where there is none, and sweeps what other writers left. Throws
  /// IoError where another process writes, the folder cannot be written, is that of something else, or a manifest is
  /// damaged.
  explicit CityWriter(std::filesystem::path folder);

  /// Where nothing was published, removes the tiles that were saved, and the folder if it is new.
  ~CityWriter();
  CityWriter(const CityWriter&) = delete;
  CityWriter& operator=(const CityWriter&) = delete;

  const std::filesystem::path& folder() const { return folder_; }

  /// The city as it is; nothing in a new folder.
  const std::optional<City>& current() const { return current_; }

  /// How many epochs the city keeps, the latest included.
  std::size_t num_epochs() const { return num_epochs_; }

  /// Saves a tile under the name of its content and counts it. Several threads may save tiles at a time.
  CityTile save_tile(const TileId& id, const VoxelMap& tile, float density,
                     const std::optional<Visibility>& visibility = {}) const;

  /// Takes a tile that lies in another city: another name of the same file where the file system knows that, else a
  /// copy. Throws IoError, malformed where it is not the file that `tile` says.
  void adopt_tile(const CityTile& tile, const std::filesystem::path& city) const;

  /// Saves the sums of a source under the name of their content; see write_part(). The folder of parts is made.
  CityPart save_part(const PartNotes& found, std::span<const TileId> ids, const PackedTile& packed) const;

  /// Makes this the city, once all of its tiles are on disk. The manifest before is kept where it is of another epoch;
  /// of all epochs the latest `keep_epochs`, which is 1 or more.
  void publish(const CityManifest& manifest, std::size_t keep_epochs);

 private:
  void sweep() const;

  std::filesystem::path folder_;
  bool is_new_;
  std::optional<CityLock> lock_;
  std::optional<City> current_;
  std::size_t num_epochs_ = 0;
  bool is_published_ = false;
};

}  // namespace vdbmap
