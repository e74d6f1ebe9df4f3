// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/file/read_finding.h"

namespace vdbmap {

/// [bytes] of the header up to version 1.2, and in 1.3 without waveforms.
inline constexpr std::uint16_t kLasHeaderSize = 227;

/// What a writer leaves for the number of points that it does not know yet; others leave 0.
inline constexpr std::uint64_t kUnknownLasCount = std::numeric_limits<std::uint64_t>::max();

/// Where a point record holds what; its coordinates are at byte 0 and its intensity at 12.
struct LasPointFormat {
  std::size_t length = 0;  ///< [bytes] without extra bytes
  std::size_t classification_at = 15;
  std::uint8_t classification_mask = 0x1f;
  std::size_t withheld_at = 15;
  std::uint8_t withheld_mask = 0x80;
  std::optional<std::size_t> time_at;
  std::optional<std::size_t> color_at;
};

/// The layout of point data record formats 0..10, nothing beyond.
std::optional<LasPointFormat> find_las_point_format(unsigned format);

/// The part of the public header block that reading needs.
struct LasHeader {
  unsigned minor_version = 0;
  bool prefers_wkt = false;            ///< the WKT record, not the GeoTIFF keys, is the reference system
  bool has_flags = true;               ///< since version 1.1 the classification byte holds flags too
  std::uint64_t size = 0;              ///< [bytes] of the header
  std::uint64_t points_offset = 0;     ///< [bytes] from the front of the file, in which they lie
  std::uint64_t num_records = 0;       ///< variable length records between header and points
  std::uint64_t waveforms_offset = 0;  ///< [bytes] from the front of the file; 0: none in it
  std::uint64_t extended_offset = 0;   ///< [bytes] from the front of the file
  std::uint64_t num_extended_records = 0;
  unsigned format_number = 0;  ///< of the points' format, 0 to 10
  bool is_compressed = false;  ///< LAZ: the points are not stored as the format says
  LasPointFormat format;
  std::uint64_t record_length = 0;      ///< [bytes] of a point
  std::uint64_t num_points = 0;         ///< as the header says, true or not; 0 or kUnknownLasCount: unknown
  std::uint64_t legacy_num_points = 0;  ///< the older number of 32 bits, all there is before version 1.4
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  std::vector<ReadFinding> findings;  ///< what is not true in it, apart from the number of points
};

/// Reads the header of LAS 1.0 to 1.4. Throws IoError where points cannot be read by it.
LasHeader read_las_header(ByteReader& file);

}  // namespace vdbmap
