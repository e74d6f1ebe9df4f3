// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/table/table_cells.h"

#include <algorithm>
#include <array>

#include "vdbmap/io/file/text.h"

namespace vdbmap {
namespace {

// A blank that parts no columns; where any number of blanks does, all of them may go.
bool is_padding(char c, const TableFormat& format) {
  return is_blank(c) && (format.separator == ' ' || c != format.separator);
}

void skip_padding(std::string_view& rest, const TableFormat& format) {
  while (!rest.empty() && is_padding(rest.front(), format)) rest.remove_prefix(1);
}

std::string_view without_padding_behind(std::string_view text, const TableFormat& format) {
  while (!text.empty() && is_padding(text.back(), format)) text.remove_suffix(1);
  return text;
}

// Where the comment of a line begins, or its end.
std::size_t find_comment(std::string_view line) {
  if (line.find('#') == std::string_view::npos && line.find('/') == std::string_view::npos) return line.size();
  for (std::size_t i = line.find_first_of("#/"); i < line.size(); i = line.find_first_of("#/", i + 1)) {
    const bool is_mark = line[i] == '#' || line.substr(i, 2) == "//";
    if (is_mark && (i == 0 || is_blank(line[i - 1]) || line[i - 1] == ',' || line[i - 1] == ';')) return i;
  }
  return line.size();
}

std::string_view cut_quoted(std::string_view& rest, const TableFormat& format) {
  const std::size_t end = std::min(rest.find('"', 1), rest.size());
  const std::string_view cell = rest.substr(1, end - 1);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  skip_padding(rest, format);
  if (!rest.empty() && rest.front() == format.separator) rest.remove_prefix(1);
  return cell;
}

std::optional<double> number_with_comma(std::string_view cell) {
  std::array<char, 64> copy;
  if (cell.size() > copy.size() || cell.find('.') != std::string_view::npos) return std::nullopt;
  std::ranges::replace_copy(cell, copy.begin(), ',', '.');
  return parse_number({copy.data(), cell.size()});
}

}  // namespace

std::string_view without_comment(std::string_view line, const TableFormat& format) {
  const std::size_t begin = find_comment(line);
  const bool is_name =
      begin > 0 && format.separator != ' ' && line.find(format.separator, begin) != std::string_view::npos;
  return without_padding_behind(is_name ? line : line.substr(0, begin), format);
}

std::optional<std::string_view> next_cell(std::string_view& rest, const TableFormat& format) {
  skip_padding(rest, format);
  if (rest.empty()) return std::nullopt;
  if (rest.front() == '"') return cut_quoted(rest, format);
  if (format.separator == ' ') {
    const auto* const end = std::find_if(rest.begin(), rest.end(), is_blank);
    const std::string_view cell(rest.begin(), end);
    rest.remove_prefix(cell.size());
    return cell;
  }
  const std::size_t end = std::min(rest.find(format.separator), rest.size());
  const std::string_view cell = without_padding_behind(rest.substr(0, end), format);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return cell;
}

std::optional<double> next_plain_number(std::string_view& rest, const TableFormat& format) {
  if (format.has_decimal_comma) return std::nullopt;
  std::string_view after = rest;
  skip_padding(after, format);
  const auto number = cut_plain_number(after, [&](char c) { return c == format.separator || is_padding(c, format); });
  if (!number) return std::nullopt;
  if (format.separator != ' ') {
    skip_padding(after, format);
    if (!after.empty() && after.front() != format.separator) return std::nullopt;
    if (!after.empty()) after.remove_prefix(1);
  }
  rest = after;
  return number;
}

std::vector<std::string_view> split_cells(std::string_view line, const TableFormat& format) {
  std::vector<std::string_view> cells;
  for (auto cell = next_cell(line, format); cell && cells.size() <= kMostColumns; cell = next_cell(line, format)) {
    cells.push_back(*cell);
  }
  return cells;
}

bool ends_with_separator(std::string_view line, const TableFormat& format) {
  return format.separator != ' ' && !line.empty() && line.back() == format.separator;
}

std::optional<double> cell_number(std::string_view cell, const TableFormat& format) {
  if (format.has_decimal_comma) return number_with_comma(cell);
  return parse_number(cell);
}

}  // namespace vdbmap
