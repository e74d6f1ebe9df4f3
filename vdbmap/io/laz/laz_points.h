// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/las/las_columns.h"
#include "vdbmap/io/las/las_header.h"
#include "vdbmap/io/las/las_records.h"
#include "vdbmap/io/laz/chunk_list.h"
#include "vdbmap/io/laz/laszip_record.h"

namespace vdbmap::laz {

/// The chunks of a LAZ file of which nothing is known to be wrong, to be read some at a time. Keeps references to the
/// file, which may be read on demand, and to its header.
class LazChunks {
 public:
  /// Nothing where something is wrong with the list of chunks or their numbers of points, and for the one chunk of the
  /// first LASzip: these are for read_laz_points(). Throws IoError as it does.
  static std::optional<LazChunks> find(const ByteReader& file, const LasHeader& header, const LasRecords& records);

  std::size_t size() const { return chunks_.size(); }
  std::uint64_t num_points() const;

  /// Where a chunk begins, [bytes] from the front of the file.
  std::uint64_t begin_of(std::size_t chunk) const { return chunks_[chunk].begin; }

  /// How many chunks from `first` on have no more than `most_points` together; 1 at least.
  std::size_t count_within(std::size_t first, std::size_t most_points) const;

  /// Points as store_las_points() leaves them, and whether read_laz_points() would leave out any, withheld or damaged.
  struct Points {
    PointCloud cloud;
    bool has_left_out = false;
  };

  /// Decodes `count` chunks, 1 or more, on all threads allowed.
  Points read(std::size_t first, std::size_t count) const;

 private:
  LazChunks(const ByteReader& file, const LasHeader& header, const LaszipRecord& laszip, std::vector<Chunk> chunks)
      : file_(&file), header_(&header), laszip_(laszip), chunks_(std::move(chunks)) {}

  const ByteReader* file_;
  const LasHeader* header_;
  LaszipRecord laszip_;
  std::vector<Chunk> chunks_;
};

/// Decodes the chunks on all threads allowed; those that are not whole are left out, and their points counted. Takes
/// memory for no more points than the chunks have bytes, or than were found to be in them. Throws IoError where the
/// compression is not one that LASzip writes, and for waveforms.
LasPoints read_laz_points(const ByteReader& file, const LasHeader& header, const LasRecords& records);

}  // namespace vdbmap::laz
