// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "vdbmap/io/las/las_header.h"
#include "vdbmap/io/las/las_records.h"

namespace vdbmap::laz {

/// How the points of a LAZ file are compressed: its "laszip encoded" record.
struct LaszipRecord {
  bool is_layered = false;  ///< each attribute of a chunk stands by itself (point formats from 6 on)
  bool is_chunked = true;   ///< else one chunk holds all points, and no table leads to it
  bool has_fixed_chunks = true;
  std::uint64_t points_per_chunk = 0;  ///< of fixed chunks, all but the last

  unsigned version = 2;  ///< of the compressed items: 1 or 2 point by point, 3 or 4 layered
  bool has_time = false;
  bool has_color = false;
  bool has_infrared = false;
  std::size_t num_extra_bytes = 0;  ///< of a point
};

/// Whether the points of a file with these records are compressed.
bool is_compressed(const std::vector<LasRecord>& records);

/// Reads the record, and makes sure that it describes the points of the header. Throws IoError where there is none, and
/// for what is not read: waveforms, and layouts that LASzip does not write.
LaszipRecord read_laszip_record(const std::filesystem::path& path, const LasHeader& header,
                                const std::vector<LasRecord>& records);

}  // namespace vdbmap::laz
