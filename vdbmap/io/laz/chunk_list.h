// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/las/las_header.h"
#include "vdbmap/io/las/las_records.h"
#include "vdbmap/io/laz/laszip_record.h"

namespace vdbmap::laz {

/// [bytes] in front of the first chunk: where the table of chunks is.
inline constexpr std::uint64_t kTableOffsetSize = 8;

/// Points that are compressed together, without any others.
struct Chunk {
  std::uint64_t begin = 0;  ///< [bytes] from the front of the file
  std::uint64_t end = 0;
  std::uint64_t num_points = 0;
  bool ends_exactly = true;  ///< whether its bytes are used up by its points, all of them
};

/// The chunks that are to be decoded, whatever the header says.
struct ChunkList {
  std::vector<Chunk> chunks;
  std::vector<ReadFinding> findings;

  std::uint64_t num_points() const;
};

/// Finds the chunks by their table, or where that is missing or wrong by one after the other. In a file that was cut
/// off those that are whole; the findings count the points of the others.
ChunkList find_chunks(const ByteReader& file, const LasHeader& header, const LasRecords& records,
                      const LaszipRecord& laszip);

}  // namespace vdbmap::laz
