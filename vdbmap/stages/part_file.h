// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "vdbmap/core/map_history.h"
#include "vdbmap/stages/job_folder.h"
#include "vdbmap/store/source_points.h"
#include "vdbmap/store/tile_sums.h"

/// The sums of one source: of each tile that it reaches into, or comes near, those of the tile's own voxels and of the
/// margin around it, packed. Behind them a description as JSON, and its size and hash: a file that was cut is seen at
/// its end. The same source and plan give the same bytes.
namespace vdbmap {

/// What was found in a source.
struct PartNotes {
  MapSource source;  ///< its epoch is decided at the end
  PointKinds kinds;
  InputNotes notes;
};

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
  PartNotes found;
  std::vector<PartTile> tiles;  ///< by bucket, then sorted
};

/// Writes the part of a source, and takes its sums. Throws IoError (system).
void write_part(const Job& job, std::size_t source, const PartNotes& found, TileSums& sums);

/// Opens the part of a source. Throws IoError: malformed where it was cut, is damaged, of another version, plan or
/// source.
Part open_part(const Job& job, std::size_t source);

/// Adds the sums of a tile to blocks. Throws IoError, malformed where they are damaged.
void add_tile_of_part(const Part& part, const PartTile& tile, VoxelBlocks& blocks);

}  // namespace vdbmap
