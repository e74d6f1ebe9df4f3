// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/table/xyz_rows.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "vdbmap/io/file/text.h"
#include "vdbmap/io/points/point_cloud_filter.h"

namespace vdbmap {

XyzRows::XyzRows(XyzLayout layout, const TableFormat& format, std::optional<XyzHeader> header,
                 std::optional<CountLine> count)
    : layout_(std::move(layout)),
      format_(format),
      header_(std::move(header)),
      count_(count),
      collector_(layout_.columns) {
  if (!layout_.note.empty()) findings_.push_back({layout_.note});
}

// Whether the row gives a point its coordinates, and has the columns that it should have: else nobody knows which of
// them is missing.
bool XyzRows::try_row(std::string_view row) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  lacks_value_ = false;
  std::string_view rest = row;
  const std::size_t width = layout_.columns.size();
  for (std::size_t i = 0; i < width; ++i) {
    const std::optional<PointField>& field = layout_.columns[i];
    std::optional<double> number = field ? next_plain_number(rest, format_) : std::nullopt;
    if (!number) {
      const std::optional<std::string_view> cell = next_cell(rest, format_);
      if (!cell && (i + 1 < width || !ends_with_separator(row, format_))) return false;
      if (!field) continue;
      number = cell_number(cell.value_or(std::string_view()), format_);
      if (!number && is_coordinate(field->role)) return false;
    }
    const bool is_value = number && is_possible(*field, *number);
    lacks_value_ = lacks_value_ || !is_value;
    collector_.set(i, is_value ? *number : kNone);
  }
  for (auto surplus = next_cell(rest, format_); surplus; surplus = next_cell(rest, format_)) {
    if (!surplus->empty()) return false;
  }
  return true;
}

void XyzRows::note_missing_values(std::uint64_t line, std::string_view row) {
  std::string_view rest = row;
  for (std::size_t i = 0; i < layout_.columns.size(); ++i) {
    const std::string_view cell = next_cell(rest, format_).value_or(std::string_view());
    const std::optional<PointField>& field = layout_.columns[i];
    if (!field) continue;
    const std::optional<double> number = cell_number(cell, format_);
    if (number && is_possible(*field, *number)) continue;
    const std::string expected = number ? text_of_possible(*field) : "a number";
    missing_.add(i, line, cell, cell.empty() ? "is empty" : quoted(cell) + " is not " + expected);
  }
}

std::string XyzRows::reason_of_broken(std::string_view row) const {
  const std::vector<std::string_view> cells = split_cells(row, format_);
  const std::size_t width = layout_.columns.size();
  for (std::size_t i = 0; i < std::min(width, cells.size()); ++i) {
    const bool is_needed = layout_.columns[i] && is_coordinate(layout_.columns[i]->role);
    if (!is_needed || cell_number(cells[i], format_)) continue;
    const std::string fault = cells[i].empty() ? "is empty" : quoted(cells[i]) + " is not a number";
    return "column " + std::to_string(i + 1) + ": " + fault;
  }
  return "found " + std::to_string(cells.size()) + " columns, expected " + std::to_string(width);
}

void XyzRows::close_block() {
  const std::size_t num_found = num_points() - begin_of_block_;
  begin_of_block_ = num_points();
  if (!count_ || count_->count == num_found) return;
  const std::string where = "line " + std::to_string(count_->line) + " promises " + std::to_string(count_->count) +
                            " points, " + std::to_string(num_found) + " follow";
  add_finding(findings_, {"counts of points that are not met", 1, where, true});
}

void XyzRows::read_other_line(const ByteReader& file, std::string_view line, std::string_view row) {
  const std::optional<std::uint64_t> count = parse_count_line(line, format_);
  if (count_ && count) {
    close_block();
    count_ = CountLine{*count, file.line()};
    return;
  }
  if (is_marked_comment(line)) return;
  const XyzHeader names = split_header(line, format_);
  if (header_ && names.names == header_->names) {
    return add_finding(findings_, {"repeated headers passed over", 1, "line " + std::to_string(file.line())});
  }
  if (names.names_coordinates()) file.fail_line("another header with x, y and z, of other columns");
  broken_.add(num_points(), file.line(), reason_of_broken(row));
}

void XyzRows::read(const ByteReader& file, std::string_view line) {
  const std::string_view row = without_comment(line, format_);
  std::string_view first = row;
  if (next_word(first).empty()) return;
  if (!try_row(row)) return read_other_line(file, line, row);
  if (lacks_value_) note_missing_values(file.line(), row);
  collector_.finish_point();
}

ReadResult XyzRows::finish(const std::filesystem::path& path) {
  close_block();
  broken_.check(path, collector_.size());
  broken_.note(findings_);
  PointCloud cloud = collector_.finish();
  missing_.finish(cloud, layout_.columns, layout_.names, findings_);
  return finish_reading(path, std::move(cloud), broken_.places(), std::move(findings_));
}

}  // namespace vdbmap
