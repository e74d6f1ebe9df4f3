// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "vdbmap/store/city_folder.h"

namespace vdbmap {

/// Hash of a tile and the eight around it: what is computed of a tile and its surroundings is the same as long as this
/// is. Nothing where one of those around it is in the city but not among `tiles`, which are sorted.
std::optional<std::uint64_t> neighborhood_hash(const CityManifest& manifest, std::span<const CityTile> tiles,
                                               const CityTile& tile);

/// Results that take long to compute, kept in the folder of a city: cache/X_Y.HASH.NAME, of the tile whose file has
/// that hash. Whoever may read the city may use them; where its folder cannot be written, nothing is kept. Writers of
/// the city remove those of tiles that are gone.
class TileCache {
 public:
  /// Results of one kind: `name` is a word.
  TileCache(const std::filesystem::path& city_folder, std::string name);

  /// What was kept of the tile under the same key; nothing where there is none, or it was damaged.
  std::optional<std::string> read(const CityTile& tile, std::uint64_t key) const;

  /// Keeps the bytes, if possible.
  void write(const CityTile& tile, std::uint64_t key, std::string_view bytes) const;

 private:
  std::filesystem::path path_of(const CityTile& tile) const;

  std::filesystem::path folder_;
  std::string name_;
};

}  // namespace vdbmap
