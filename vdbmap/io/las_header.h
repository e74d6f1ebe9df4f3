// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "vdbmap/io/byte_reader.h"

namespace vdbmap {

/// [bytes] of the header up to version 1.2, and in 1.3 without waveforms.
inline constexpr std::uint16_t kLasHeaderSize = 227;

/// Where a point record holds what; its coordinates are at byte 0 and its intensity at 12.
struct LasPointFormat {
  std::size_t length = 0;  ///< [bytes] without extra bytes
  std::size_t classification_at = 15;
  std::uint8_t classification_mask = 0x1f;
  std::optional<std::size_t> time_at;
  std::optional<std::size_t> color_at;
};

/// The layout of point data record formats 0..10, nothing beyond.
std::optional<LasPointFormat> find_las_point_format(unsigned format);

/// The part of the public header block that reading needs.
struct LasHeader {
  unsigned minor_version = 0;
  bool prefers_wkt = false;           ///< the WKT record, not the GeoTIFF keys, is the reference system
  std::uint64_t size = 0;             ///< [bytes] of the header
  std::uint64_t points_offset = 0;    ///< [bytes] from the front of the file
  std::uint64_t num_records = 0;      ///< variable length records between header and points
  std::uint64_t extended_offset = 0;  ///< [bytes] from the front of the file
  std::uint64_t num_extended_records = 0;
  LasPointFormat format;
  std::uint64_t record_length = 0;  ///< [bytes] of a point
  std::uint64_t num_points = 0;     ///< the file is as long as these need
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
};

/// Reads and checks the header of LAS 1.0 to 1.4. Throws IoError, for compressed points too.
LasHeader read_las_header(ByteReader& file);

/// A variable length record.
struct LasRecord {
  std::string_view user;
  unsigned id = 0;
  std::string_view data;  ///< lives as long as the file's reader
};

/// All records, the extended ones last. Throws IoError where one leaves its place.
std::vector<LasRecord> read_las_records(ByteReader& file, const LasHeader& header);

}  // namespace vdbmap
