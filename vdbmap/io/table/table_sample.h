// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vdbmap/io/table/table_cells.h"

namespace vdbmap {

/// Some lines of a text table, which stand for all of them.
struct TableSample {
  TableFormat format;
  std::size_t num_columns = 0;                      ///< of most rows
  bool has_empty_last_column = false;               ///< most rows end with a separator
  std::vector<std::vector<std::string_view>> rows;  ///< cells of the rows that have `num_columns`
};

/// Why a table cannot be read for sure.
struct TableDoubt {
  std::string_view line;
  std::string reason;
};

/// Whether cells are a row of a table of points: three of them are numbers.
bool is_row(const std::vector<std::string_view>& cells, const TableFormat& format);

/// A sample of the lines: the first ones and some spread over the rest, always the same ones. The format is that which
/// makes numbers of most of their cells; a decimal comma, where another mark parts the columns. Nothing where no line
/// holds three numbers.
std::optional<TableSample> take_sample(std::string_view text);

/// A decimal comma that may be a mark between thousands or between columns, or goes along with decimal points.
std::optional<TableDoubt> find_doubtful_comma(const TableSample& sample);

/// Whether every second cell may be the decimals of the one before: "389012,45,5812345,12,55,30".
bool may_be_halves_of_numbers(const TableSample& sample);

}  // namespace vdbmap
