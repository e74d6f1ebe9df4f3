// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/file/scalar_type.h"
#include "vdbmap/io/pcd/pcd.h"

namespace vdbmap {

struct PcdField {
  std::string name;
  ScalarType type;
  std::uint64_t count;  ///< of numbers in each point, at least 1

  std::uint64_t size() const { return size_of(type) * count; }  ///< [bytes]
};

struct PcdHeader {
  std::vector<PcdField> fields;
  std::uint64_t fields_line;  ///< of FIELDS, from 1
  std::uint64_t num_points;
  std::uint64_t num_points_line;  ///< of POINTS, or of WIDTH, from 1
  PcdEncoding encoding;
  std::vector<ReadFinding> findings;  ///< what contradicts itself

  std::uint64_t point_size() const;         ///< [bytes]
  std::uint64_t numbers_per_point() const;  ///< of all fields together
};

/// Keywords may be in small letters. Where POINTS is not WIDTH x HEIGHT, the larger is taken: the data show how many
/// there are. Reads to the end of the line DATA and leaves the reader at the first byte of data. Throws IoError with
/// the line.
PcdHeader read_pcd_header(ByteReader& reader);

}  // namespace vdbmap
