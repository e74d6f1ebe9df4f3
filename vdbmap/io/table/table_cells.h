// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace vdbmap {

/// More columns are no table of points, and would take memory out of proportion to the file.
inline constexpr std::size_t kMostColumns = 1000;

/// How the lines of a text table are parted and their numbers written.
struct TableFormat {
  char separator = ' ';  ///< ',', ';', '|' or a tab, each between two columns; ' ': any number of blanks and tabs
  bool has_decimal_comma = false;

  bool operator==(const TableFormat&) const = default;
};

/// A line without the comment ('#' or '//') at its end, and without blanks there. Behind such a mark no column follows:
/// in "Car #2,1,2,3" it belongs to a name.
std::string_view without_comment(std::string_view line, const TableFormat& format);

/// Cuts the next cell off the front of `rest`, without blanks around it and quotes; nothing at the line's end. A
/// separator at the line's end is followed by no cell.
std::optional<std::string_view> next_cell(std::string_view& rest, const TableFormat& format);

/// next_cell() and cell_number() in one, for numbers in their usual spelling; nothing, and `rest` as it was, for
/// others.
std::optional<double> next_plain_number(std::string_view& rest, const TableFormat& format);

/// The cells of a line; of one that ends with a separator there is none behind it. One more than kMostColumns
/// at most.
std::vector<std::string_view> split_cells(std::string_view line, const TableFormat& format);

/// Whether a line ends with a separator that is no blank: the cell behind it is empty.
bool ends_with_separator(std::string_view line, const TableFormat& format);

/// A whole cell as a number.
std::optional<double> cell_number(std::string_view cell, const TableFormat& format);

}  // namespace vdbmap
