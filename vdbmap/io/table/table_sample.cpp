// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/table/table_sample.h"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/file/text.h"

namespace vdbmap {
namespace {

constexpr std::size_t kFirstLines = 128;
constexpr std::size_t kSpreadLines = 128;

std::string_view cut_line(std::string_view& rest, char line_end) {
  const std::size_t end = std::min(rest.find(line_end), rest.size());
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return line;
}

std::vector<std::string_view> sample_lines(std::string_view text) {
  const char line_end = line_end_of(text);
  std::string_view rest = text;
  std::vector<std::string_view> lines;
  while (lines.size() < kFirstLines && !rest.empty()) {
    const std::string_view line = cut_line(rest, line_end);
    if (!split_words(line.substr(0, 64)).empty()) lines.push_back(line);
  }
  for (std::size_t i = 0; i < kSpreadLines && rest.size() > kSpreadLines; ++i) {
    std::string_view place = rest.substr(rest.size() / kSpreadLines * i);
    cut_line(place, line_end);  // begins anywhere
    lines.push_back(cut_line(place, line_end));
  }
  return lines;
}

bool is_comment(std::string_view line) {
  std::string_view rest = line;
  const std::string_view word = next_word(rest);
  return word.starts_with('#') || word.starts_with("//");
}

using Cells = std::vector<std::string_view>;

std::size_t count_numbers(const Cells& cells, const TableFormat& format) {
  return static_cast<std::size_t>(
      std::ranges::count_if(cells, [&](std::string_view cell) { return cell_number(cell, format).has_value(); }));
}

std::vector<Cells> rows_of(const std::vector<std::string_view>& lines, const TableFormat& format) {
  std::vector<Cells> rows;
  for (const std::string_view line : lines) {
    if (is_comment(line)) continue;
    Cells cells = split_cells(without_comment(line, format), format);
    if (is_row(cells, format)) rows.push_back(std::move(cells));
  }
  return rows;
}

std::pair<std::size_t, std::size_t> most_frequent_width(const std::vector<Cells>& rows) {
  std::map<std::size_t, std::size_t> rows_of_width;
  for (const Cells& cells : rows) ++rows_of_width[cells.size()];
  const auto most = std::ranges::max_element(rows_of_width, {}, &std::pair<const std::size_t, std::size_t>::second);
  return most == rows_of_width.end() ? std::pair<std::size_t, std::size_t>() : std::pair(most->first, most->second);
}

// The more numbers, the more rows alike and the fewer cells of something else, the likelier is a format.
std::tuple<std::size_t, std::size_t, long> likelihood(const std::vector<Cells>& rows, const TableFormat& format) {
  std::size_t num_numbers = 0;
  long num_others = 0;
  for (const Cells& cells : rows) {
    const std::size_t count = count_numbers(cells, format);
    num_numbers += count;
    num_others += static_cast<long>(cells.size() - count);
  }
  return {num_numbers, most_frequent_width(rows).second, -num_others};
}

// Whether a mark stands in half of the lines: else it belongs to a name or a remark.
bool parts_columns(const std::vector<std::string_view>& lines, char separator) {
  std::size_t num_with = 0;
  std::size_t num_lines = 0;
  for (const std::string_view line : lines) {
    if (is_comment(line)) continue;
    ++num_lines;
    num_with += line.find(separator) != std::string_view::npos ? 1 : 0;
  }
  return num_with > 0 && 2 * num_with >= num_lines;
}

TableFormat find_format(const std::vector<std::string_view>& lines) {
  constexpr std::array<char, 5> kSeparators = {';', '|', ',', '\t', ' '};
  const bool has_semicolons = parts_columns(lines, ';');
  std::optional<TableFormat> best;
  std::tuple<std::size_t, std::size_t, long> best_likelihood;
  for (const bool has_decimal_comma : {false, true}) {
    for (const char separator : kSeparators) {
      // Of a comma and a semicolon in one table, the semicolon parts the columns.
      if (separator != ' ' && (!parts_columns(lines, separator) || (separator == ',' && has_semicolons))) continue;
      const TableFormat format{separator, has_decimal_comma};
      const auto value = likelihood(rows_of(lines, format), format);
      if (best && value <= best_likelihood) continue;
      best = format;
      best_likelihood = value;
    }
  }
  return *best;
}

bool is_digits(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

// "1,234" may be a thousand or one and a bit.
bool may_have_thousands(std::string_view cell) {
  if (cell.starts_with('-')) cell.remove_prefix(1);
  const std::size_t comma = cell.find(',');
  return comma != std::string_view::npos && comma <= 3 && cell.size() == comma + 4;
}

}  // namespace

bool is_row(const Cells& cells, const TableFormat& format) { return count_numbers(cells, format) >= 3; }

std::optional<TableSample> take_sample(std::string_view text) {
  const std::vector<std::string_view> lines = sample_lines(text);
  TableSample sample;
  sample.format = find_format(lines);
  std::size_t num_ends = 0;
  std::vector<Cells> rows = rows_of(lines, sample.format);
  if (rows.empty()) return std::nullopt;
  sample.num_columns = most_frequent_width(rows).first;
  std::erase_if(rows, [&](const Cells& cells) { return cells.size() != sample.num_columns; });
  for (const std::string_view line : lines) {
    num_ends += ends_with_separator(without_comment(line, sample.format), sample.format) ? 1 : 0;
  }
  sample.has_empty_last_column = 2 * num_ends > rows.size();
  sample.rows = std::move(rows);
  return sample;
}

std::optional<TableDoubt> find_doubtful_comma(const TableSample& sample) {
  if (sample.format.separator == ',' && !sample.format.has_decimal_comma) return std::nullopt;
  const TableFormat other{sample.format.separator, !sample.format.has_decimal_comma};
  bool has_comma = false;
  bool has_only_thousands = true;
  for (const Cells& cells : sample.rows) {
    for (const std::string_view cell : cells) {
      const bool is_number = cell_number(cell, sample.format).has_value();
      if (!is_number && cell_number(cell, other)) return TableDoubt{cell, "has another decimal mark than others"};
      if (!is_number || cell.find(',') == std::string_view::npos) continue;
      has_comma = true;
      has_only_thousands = has_only_thousands && may_have_thousands(cell);
    }
  }
  if (!has_comma || !has_only_thousands) return std::nullopt;
  return TableDoubt{sample.rows.front().front(), "has a comma that may part thousands or decimals"};
}

bool may_be_halves_of_numbers(const TableSample& sample) {
  if (sample.format.separator != ',' || sample.num_columns < 6 || sample.num_columns % 2 != 0) return false;
  const std::size_t num_decimals = sample.rows.front()[1].size();
  bool has_leading_zero = false;
  for (const Cells& cells : sample.rows) {
    for (std::size_t i = 1; i < cells.size(); i += 2) {
      const std::string_view whole = cells[i - 1].substr(cells[i - 1].starts_with('-') ? 1 : 0);
      if (!is_digits(whole) || !is_digits(cells[i]) || cells[i].size() != num_decimals) return false;
      has_leading_zero = has_leading_zero || cells[i].starts_with('0');
    }
  }
  return num_decimals >= 2 || has_leading_zero;
}

}  // namespace vdbmap
