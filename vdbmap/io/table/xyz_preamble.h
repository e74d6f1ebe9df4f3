// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/file/read_finding.h"
#include "vdbmap/io/table/table_cells.h"
#include "vdbmap/io/table/xyz_header.h"

namespace vdbmap {

/// A line that says how many points follow it.
struct CountLine {
  std::uint64_t count = 0;
  std::uint64_t line = 0;
};

/// The whole number that a line consists of.
std::optional<std::uint64_t> parse_count_line(std::string_view line, const TableFormat& format);

/// What stands before the first row of a text table.
struct XyzPreamble {
  std::optional<XyzHeader> header;    ///< names x, y and z
  std::optional<XyzHeader> text;      ///< the first line that is neither that nor a comment
  std::vector<ReadFinding> findings;  ///< such lines
  std::optional<CountLine> count;     ///< how many points follow
  std::optional<std::string_view> first_row = {};
};

/// Reads up to the first row of a table of points, whose rows have `num_columns` as a rule. Throws IoError for two
/// headers that differ, and for a PTX scan.
XyzPreamble read_preamble(ByteReader& file, const TableFormat& format, std::size_t num_columns);

/// Throws IoError for text that is no table of points but would look like one: meshes, grids, UTF-16.
void refuse_foreign_text(const ByteReader& file);

}  // namespace vdbmap
