// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vdbmap/core/map_history.h"
#include "vdbmap/core/tile_id.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap {

/// What every tile of a city is like.
struct CityLayout {
  MapFrame frame;
  std::vector<double> voxel_sizes;  ///< [m] finest first
  bool has_color = false;
  std::vector<std::string> channels;  ///< names of for_each_channel() that the voxels have, in its order
  LabelScheme label_scheme = LabelScheme::kUnknown;
  float density = 0;  ///< [1/m] of the fog that renderers see

  bool operator==(const CityLayout&) const = default;
};

/// The box around nothing: least and largest are infinite, so that any box joined with it stays what it is.
inline const Extent kNoExtent{Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()),
                              Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity())};

/// A file of a city. What is counted here is what the file holds: `check` compares them.
struct CityTile {
  TileId id;
  std::string hash;                       ///< the checksum of the file, 20 hexadecimal digits: a part of its name
  std::uint64_t num_bytes = 0;            ///< of the file
  std::uint64_t num_points = 0;           ///< counted in its voxels
  std::vector<std::uint64_t> num_voxels;  ///< a level
  Extent extent = kNoExtent;              ///< of its voxels [m, original system]; without one kNoExtent
  bool has_rays = false;                  ///< whether the file says what rays saw

  bool operator==(const CityTile& other) const;
};

/// The sums of a source that a city keeps (part_file.h).
struct CityPart {
  std::string source;           ///< hash of the source
  std::string hash;             ///< of the part, 32 hexadecimal digits: its name
  std::uint64_t num_bytes = 0;  ///< of the file

  bool operator==(const CityPart&) const = default;
};

/// What a city is in one epoch.
struct CityManifest {
  std::int32_t epoch = 0;  ///< number of the latest survey in it; 0 where none was given
  CityLayout layout;
  std::vector<CityTile> tiles;        ///< sorted, each with a voxel at least, or what rays saw
  std::vector<MapSource> sources;     ///< sorted by epoch, name and hash
  std::vector<MapEpoch> epochs = {};  ///< sorted by number: those of which a date or what changed is known
  std::vector<CityPart> parts = {};   ///< sorted by source; empty where none are kept

  bool operator==(const CityManifest&) const = default;
};

/// Version of the manifests that we write; of newer ones nothing is known. Cities of version 1 have no rays and no
/// dates, and are still written as such: a program that knows no more would lose the rays of what it adds to.
inline constexpr std::int32_t kCityFormat = 2;

/// The manifest as JSON, a line a tile and a source. Equal manifests give equal texts.
std::string text_of(const CityManifest& manifest);

/// Reads what text_of() wrote. Throws IoError (malformed), naming `path` and the place, for anything else: a text that
/// was cut, numbers that cannot be, a newer version.
CityManifest parse_city_manifest(std::string_view text, const std::filesystem::path& path);

/// The voxel sizes that some given to 1e-9 mean: a tile is a whole number of voxels.
std::vector<double> exact_voxel_sizes(std::vector<double> voxel_sizes);

/// The layout of a map.
CityLayout layout_of(const VoxelMap& map, float density);

/// The channels of a map that has voxels, by name.
std::vector<std::string> channel_names(const VoxelMap& map);

/// What is counted of a tile, apart from its file.
CityTile describe_tile(const TileId& id, const VoxelMap& tile);

/// Whether any tile says what rays saw.
bool has_rays(const CityManifest& manifest);

/// The tile of that id, or nullptr.
const CityTile* find_tile(const CityManifest& manifest, const TileId& id);

/// What is known of that epoch, or nullptr.
const MapEpoch* find_epoch(const CityManifest& manifest, std::int32_t number);

/// The date of the epoch that the city is in; empty where it is not known.
std::string date_of(const CityManifest& manifest);

/// The part of the source of that hash, or nullptr.
const CityPart* find_part(const CityManifest& manifest, const std::string& source);

/// The box around all tiles; nothing without one.
std::optional<Extent> extent(const CityManifest& manifest);

/// Whether the city keeps the sums of each of its sources: its tiles can be made anew of any of them.
bool keeps_parts(const CityManifest& manifest);

/// Points, and voxels of each level, of all tiles.
std::uint64_t num_points(const CityManifest& manifest);
std::vector<std::uint64_t> num_voxels(const CityManifest& manifest);

}  // namespace vdbmap
