// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/file/scalar_type.h"

namespace vdbmap {

struct PlyProperty {
  std::string name;
  ScalarType type;                       ///< of the number, or of a list's items
  std::optional<ScalarType> count_type;  ///< of a list's length; nothing for a plain number
  std::uint64_t line;                    ///< of the header, from 1
};

struct PlyElement {
  std::string name;
  std::uint64_t count;
  std::uint64_t line;  ///< of the header, from 1
  std::vector<PlyProperty> properties;

  bool has_lists() const;
  /// Bytes of an element without lists, and the least an element with lists can take.
  std::uint64_t least_binary_size() const;
};

struct PlyHeader {
  enum class Encoding { kAscii, kBinaryLittleEndian, kBinaryBigEndian };
  Encoding encoding;
  std::vector<PlyElement> elements;
  bool has_16_bit_colors = false;  ///< by kPlyComment16Bits: else their scale shows in their values
};

/// The comment that keeps a dark picture of 16 bits from being taken for one of 8 bits.
inline constexpr std::string_view kPlyComment16Bits = "comment colours have 16 bits";

/// Reads from "ply", behind a byte-order mark or not, to "end_header" and leaves the reader at the first byte of data.
/// Throws IoError with the line.
PlyHeader read_ply_header(ByteReader& reader);

}  // namespace vdbmap
