// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "vdbmap/io/point_fields.h"

namespace vdbmap {

/// What the columns of a text file of points are; nothing for a column without a place in a PointCloud.
struct XyzLayout {
  std::vector<std::optional<PointField>> columns;
  bool colors_have_16_bits = false;  ///< named r16, g16, b16; else their depth shows in their values
};

/// Cuts the next column off the front of `rest`: columns are parted by blanks, one comma or one semicolon. Empty where
/// nothing stands between two separators; nothing at the line's end or at a '#' or '//' comment.
std::optional<std::string_view> next_column(std::string_view& rest);

/// The number of columns of a line.
std::size_t count_columns(std::string_view line);

/// The layout that a header line names, with or without a comment marker before it; nothing unless x, y and z are among
/// its names, which are at most 1000.
std::optional<XyzLayout> layout_of_header(std::string_view line);

/// The layout of a file without header: 3 columns are x y z, 4 x y z intensity, 6 x y z r g b, 7 x y z intensity r g b.
std::optional<XyzLayout> layout_of_count(std::size_t num_columns);

}  // namespace vdbmap
