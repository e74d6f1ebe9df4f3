// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vdbmap/core/map_history.h"
#include "vdbmap/store/source_points.h"
#include "vdbmap/store/tile_sums.h"

/// The sums of one source: of each tile that it reaches into, or comes near, those of the tile's own voxels and of the
/// margin around it, packed. Behind them a description as JSON, and its size and hash: a file that was cut is seen at
/// its end. The same source, read and anchored the same way, gives the same bytes.
namespace vdbmap {

/// What was found in a source.
struct PartNotes {
  MapSource source;  ///< of its epoch nothing is said
  PointKinds kinds;
  InputNotes notes;
};

/// What a city keeps of these: what was said of the coordinates when they were counted is more than what the file says.
PartNotes to_be_kept(PartNotes found, const std::optional<int>& given_epsg);

/// What sources have in common.
struct CommonNotes {
  PointKinds kinds;
  InputNotes notes;
};

/// What read_inputs() of all of these sources would have found. Throws IoError as it does where they do not agree.
CommonNotes common_notes(std::span<const PartNotes* const> sources);

/// Where the sums of a tile are in a part.
struct PartTile {
  TileId id;
  std::uint64_t offset = 0;     ///< [bytes] from the front of the file
  std::uint64_t num_bytes = 0;  ///< packed
  std::string hash;             ///< of these bytes
};

/// A part, without its sums.
struct Part {
  std::filesystem::path path;
  std::string made_for;  ///< what write_part() was told
  std::string hash;      ///< of the description, which has those of all sums: parts of one hash are the same
  PartNotes found;
  std::vector<PartTile> tiles;  ///< in the order in which they were written
};

/// The sums of a tile as pack_sums() gives them; called by any thread.
using PackedTile = std::function<std::string(const TileId&)>;

/// Writes a part, its tiles in the order of `ids`; returns its hash. `made_for` tells it from other parts of the
/// source. Throws IoError (system).
std::string write_part(const std::filesystem::path& path, const std::string& made_for, const PartNotes& found,
                       std::span<const TileId> ids, const PackedTile& packed);

/// Opens a part of the source that has this name and file. Throws IoError: malformed where it was cut, is damaged or of
/// another version.
Part open_part(const std::filesystem::path& path, const std::string& source_name,
               const std::filesystem::path& source_file);

/// The sums of a tile, packed. Throws IoError, malformed where they are damaged.
std::string packed_tile(const Part& part, const PartTile& tile);

/// Adds the sums of a tile to blocks. Throws IoError, malformed where they are damaged.
void add_tile_of_part(const Part& part, const PartTile& tile, VoxelBlocks& blocks);

/// A tile in one of several parts.
struct TileInPart {
  const Part* part;
  const PartTile* tile;
};

/// Where the sums of tiles are in several parts.
using TilesOfParts = std::map<TileId, std::vector<TileInPart>>;

/// The tiles, sorted.
std::vector<TileId> ids_of(const TilesOfParts& tiles);

/// The sums of a tile in all of these places. Throws IoError as add_tile_of_part().
VoxelBlocks sums_of(std::span<const TileInPart> places);

}  // namespace vdbmap
