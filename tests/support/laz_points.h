// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace vdbmap::test {

/// How the records of a chunk are laid out, and compressed.
struct LazItems {
  unsigned format = 0;   ///< 0 to 3 point by point, 6 to 8 layered
  unsigned version = 2;  ///< 1 or 2, 3 or 4
  std::size_t num_extra_bytes = 0;

  bool is_layered() const { return format >= 6; }
  bool has_time() const { return format == 1 || format == 3; }
  bool has_color() const { return format == 2 || format == 3 || format >= 7; }
  bool has_infrared() const { return format == 8; }
  std::size_t record_length() const;  ///< [bytes]
};

/// Compresses records, as they stand in a LAS file, to a chunk.
std::string compress_chunk(const LazItems& items, std::string_view records);

}  // namespace vdbmap::test
