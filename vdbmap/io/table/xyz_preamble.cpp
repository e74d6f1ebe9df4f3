// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/table/xyz_preamble.h"

#include <algorithm>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/text.h"
#include "vdbmap/io/table/table_sample.h"

namespace vdbmap {
namespace {

bool is_first_row(std::string_view line, const TableFormat& format) {
  const std::vector<std::string_view> cells = split_cells(without_comment(line, format), format);
  if (is_row(cells, format)) return true;
  return cells.size() > 1 && cell_number(cells[0], format) && cell_number(cells[1], format);
}

// As long as a row and with a number in it, but not three: no names have numbers among them.
bool is_broken_row(std::string_view line, const TableFormat& format, std::size_t num_columns) {
  const std::vector<std::string_view> cells = split_cells(without_comment(line, format), format);
  const bool has_number =
      std::ranges::any_of(cells, [&](std::string_view cell) { return cell_number(cell, format).has_value(); });
  return cells.size() > 1 && cells.size() == num_columns && has_number;
}

void note_count(const ByteReader& file, XyzPreamble& preamble, std::uint64_t count) {
  if (preamble.count && preamble.count->count > 0) {
    file.fail_line("a PTX scan, whose points lie in a frame of their own: export it as PTS, PLY or LAS");
  }
  preamble.count = CountLine{count, file.line()};
}

void note_text(const ByteReader& file, XyzPreamble& preamble, std::string_view line, XyzHeader names) {
  if (names.names.size() > kMostColumns) {
    file.fail_line(quoted(line) + " is neither a point nor a header with x, y and z");
  }
  if (!names.is_comment) {
    add_finding(preamble.findings, {"lines of text before the first point passed over", 1,
                                    "line " + std::to_string(file.line()) + ": " + quoted(line)});
  }
  if (!preamble.text && (!names.is_comment || names.names_angles())) preamble.text = std::move(names);
}

void note_header(const ByteReader& file, XyzPreamble& preamble, XyzHeader names) {
  if (preamble.header && !preamble.header->is_comment && !names.is_comment && names.names != preamble.header->names) {
    file.fail_line("another header with x, y and z, of other columns");
  }
  // Of several comments the last one counts, unless it only talks of the columns.
  const bool is_comment_on_columns = names.is_comment && names.is_sentence();
  const bool is_better = preamble.header && preamble.header->is_comment && !is_comment_on_columns;
  if (!preamble.header || !names.is_comment || is_better) preamble.header = std::move(names);
}

}  // namespace

std::optional<std::uint64_t> parse_count_line(std::string_view line, const TableFormat& format) {
  std::string_view rest = without_comment(line, format);
  const std::string_view word = next_word(rest);
  return next_word(rest).empty() ? parse_count(word) : std::nullopt;
}

XyzPreamble read_preamble(ByteReader& file, const TableFormat& format, std::size_t num_columns) {
  XyzPreamble preamble;
  while (file.remaining() > 0) {
    const bool is_first_line = file.offset() == 0;
    const std::string_view line = is_first_line ? without_byte_order_mark(file.read_line()) : file.read_line();
    std::string_view rest = line;
    if (next_word(rest).empty()) continue;
    if (!is_marked_comment(line) && is_first_row(line, format)) {
      preamble.first_row = line;
      return preamble;
    }
    if (const auto count = parse_count_line(line, format)) {
      note_count(file, preamble, *count);
      continue;
    }
    XyzHeader names = split_header(line, format);
    names.line = file.line();
    if (names.names_coordinates()) {
      note_header(file, preamble, std::move(names));
    } else if (!names.is_comment && is_broken_row(line, format, num_columns)) {
      preamble.first_row = line;
      return preamble;
    } else {
      note_text(file, preamble, line, std::move(names));
    }
  }
  return preamble;
}

// Other formats that are text, and would be read as tables.
void refuse_foreign_text(const ByteReader& file) {
  const std::string_view all = file.all();
  if (all.starts_with("\xff\xfe") || all.starts_with("\xfe\xff")) {
    throw IoError::malformed(file.path(), "is UTF-16 text, expected UTF-8 or ASCII");
  }
  std::string_view rest = all.substr(0, 256);
  const std::string word = lower_case(next_word(rest));
  for (const std::string_view mesh : {"off", "coff", "noff", "cnoff", "stoff"}) {
    if (word == mesh) throw IoError::malformed(file.path(), "is an OFF mesh, expected a table of points");
  }
  if (word == "ncols") throw IoError::malformed(file.path(), "is a grid of heights (Esri), expected a table of points");
}

}  // namespace vdbmap
