// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/las/las_header.h"
#include "vdbmap/io/laz/laszip_record.h"

namespace vdbmap::laz {

/// An entry of the table that LASzip writes behind the last chunk.
struct ChunkSize {
  std::uint64_t num_points = 0;  ///< 0 where all chunks but the last are of the same number
  std::uint64_t num_bytes = 0;
};

struct ChunkTable {
  std::uint64_t begin = 0;  ///< [bytes] from the front of the file: where the last chunk ends
  std::vector<ChunkSize> chunks;
};

/// Nothing where the table is missing, as in a file that was cut off, or cannot be true: chunks of more bytes,
/// together, than there are before it.
std::optional<ChunkTable> read_chunk_table(const ByteReader& file, const LasHeader& header, const LaszipRecord& laszip);

}  // namespace vdbmap::laz
