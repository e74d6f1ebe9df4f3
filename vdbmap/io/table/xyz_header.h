// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "vdbmap/io/table/table_cells.h"

namespace vdbmap {

/// A line before the first point that may name the columns.
struct XyzHeader {
  std::vector<std::string> names;
  std::uint64_t line = 0;
  bool is_comment = false;

  /// Whether x, y and z are among the names, in any words for them.
  bool names_coordinates() const;

  /// Whether latitude and longitude are: no coordinates of a map in metres.
  bool names_angles() const;

  /// Whether it speaks of the columns in a sentence: "x y z are in metres".
  bool is_sentence() const;
};

/// Whether a line is marked as a comment: '#' or '//', and before the first point also ';', '%' and '!'.
bool is_marked_comment(std::string_view line);

/// The names in a line, parted as the points are; where that names no x, y and z, as one of the other ways does. Marks
/// of comments and a title ("columns: x y z") are left out.
XyzHeader split_header(std::string_view line, const TableFormat& format);

}  // namespace vdbmap
