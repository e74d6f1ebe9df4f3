// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/poses/pose_layout.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "vdbmap/io/file/text.h"

namespace vdbmap {
namespace {

constexpr std::size_t kMatrixColumns = 12;
constexpr std::size_t kSquareMatrixColumns = 16;
constexpr std::size_t kTumColumns = 8;
constexpr std::size_t kTime = 7;  // in the order x y z qx qy qz qw time

std::string_view without_blanks(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n\v\f";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

std::string_view bare(std::string_view field) {
  field = without_blanks(field);
  const bool is_quoted = field.size() >= 2 && field.front() == field.back() && (field[0] == '"' || field[0] == '\'');
  return is_quoted ? without_blanks(field.substr(1, field.size() - 2)) : field;
}

// In lower case, "p_RS_R_x [m]" as "p_rs_r_x[m]": units stay with their names where white space separates.
std::string with_units_joined(const std::string& header) {
  std::string joined;
  int depth = 0;
  for (const char c : header) {
    const bool opens = c == '[' || c == '(';
    if (opens) joined.erase(joined.find_last_not_of(' ') + 1);
    depth += opens ? 1 : (c == ']' || c == ')') && depth > 0 ? -1 : 0;
    if (depth == 0 || c != ' ') joined += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return joined;
}

struct ColumnName {
  std::string name;  // of letters, digits and single '_'
  std::string unit;
};

ColumnName column_name(std::string_view field) {
  ColumnName column;
  const std::size_t bracket = std::min(field.find('['), field.find('('));
  if (bracket != std::string_view::npos) {
    const std::string_view unit = field.substr(bracket + 1);
    column.unit = unit.substr(0, unit.find_first_of("])"));
  }
  for (const char c : field.substr(0, bracket)) {
    const bool is_letter = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (is_letter) column.name += c;
    if (!is_letter && !column.name.empty() && column.name.back() != '_') column.name += '_';
  }
  if (column.name.ends_with('_')) column.name.pop_back();
  return column;
}

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::ranges::find(words, word) != words.end();
}

bool ends_as_one_of(std::string_view word, std::initializer_list<std::string_view> endings) {
  return std::ranges::any_of(endings, [&](std::string_view ending) { return word.ends_with(ending); });
}

// Position in the order x y z qx qy qz qw time; nothing for other names.
std::optional<std::size_t> meaning_of(std::string_view name) {
  if (is_one_of(name, {"t", "time", "timestamp", "timestamps", "stamp", "secs", "sec", "seconds"}) ||
      ends_as_one_of(name, {"_timestamp", "_time", "_stamp", "time_s", "time_ns", "stamp_s", "stamp_ns", "time_us",
                            "stamp_us", "time_ms", "stamp_ms"})) {
    return kTime;
  }
  constexpr std::string_view kAxes = "xyzw";
  const std::size_t axis = name.empty() ? std::string_view::npos : kAxes.find(name.back());
  if (axis == std::string_view::npos) return std::nullopt;
  std::string_view prefix = name.substr(0, name.size() - 1);
  if (prefix.ends_with('_')) prefix.remove_suffix(1);
  if (is_one_of(prefix, {"q", "quat", "rot", "q_rs"}) ||
      ends_as_one_of(prefix, {"quaternion", "orientation", "rotation"})) {
    return 3 + axis;
  }
  const bool is_position = is_one_of(prefix, {"", "t", "p", "pos", "trans", "p_rs_r", "pose"}) ||
                           ends_as_one_of(prefix, {"position", "translation"});
  return is_position && axis < 3 ? std::optional(axis) : std::nullopt;
}

std::optional<double> seconds_of_unit(const ColumnName& column) {
  constexpr std::pair<std::string_view, double> kUnits[] = {{"ns", 1e-9}, {"us", 1e-6}, {"ms", 1e-3}, {"s", 1}};
  for (const auto& [unit, seconds] : kUnits) {
    if (column.unit == unit || column.name.ends_with(std::string(1, '_').append(unit))) return seconds;
  }
  return std::nullopt;
}

std::optional<PoseLayout> quaternion_layout(std::span<const ColumnName> names) {
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::array<std::size_t, kTime + 1> columns;
  columns.fill(kNone);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::optional<std::size_t> meaning = meaning_of(names[i].name);
    if (!meaning) continue;
    if (columns[*meaning] != kNone) return std::nullopt;
    columns[*meaning] = i;
  }
  PoseLayout layout;
  std::copy_n(columns.begin(), layout.columns.size(), layout.columns.begin());
  if (std::ranges::find(layout.columns, kNone) != layout.columns.end()) return std::nullopt;
  if (columns[kTime] != kNone) {
    layout.time = columns[kTime];
    layout.seconds_per_unit = seconds_of_unit(names[columns[kTime]]);
  }
  return layout;
}

// "r11 r12 r13 tx r21 ...": two digits count rows and columns from 0 or from 1.
bool is_matrix_by_rows(std::span<const ColumnName> names, std::size_t base) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::size_t row = i / 4;
    const std::size_t column = i % 4;
    std::string name = names[i].name;
    std::erase(name, '_');
    const bool is_element = name.ends_with(std::to_string(row + base) + std::to_string(column + base));
    const bool is_translation = column == 3 && row < 3 && meaning_of(names[i].name) == row;
    if (!is_element && !is_translation) return false;
  }
  return true;
}

std::optional<PoseLayout> matrix_layout(std::span<const ColumnName> names) {
  if (names.size() != kMatrixColumns && names.size() != kSquareMatrixColumns) return std::nullopt;
  if (!is_matrix_by_rows(names, 0) && !is_matrix_by_rows(names, 1)) return std::nullopt;
  return layout_of_columns(names.size());
}

std::optional<PoseLayout> layout_of_names(std::string_view header, char separator) {
  std::vector<ColumnName> names;
  for (const std::string_view field : split_fields(header, separator)) names.push_back(column_name(field));
  if (separator != ' ' && !names.empty() && names.back().name.empty()) names.pop_back();
  std::optional<PoseLayout> layout = matrix_layout(names);
  if (!layout) layout = quaternion_layout(names);
  if (!layout) return std::nullopt;
  layout->num_columns = names.size();
  layout->is_named = true;
  return layout;
}

}  // namespace

char pose_separator(std::string_view line) {
  for (const char separator : {';', ','}) {
    if (line.find(separator) != std::string_view::npos) return separator;
  }
  const bool has_tabs = line.find('\t') != std::string_view::npos;
  return has_tabs && split_fields(line, '\t').size() == split_words(line).size() ? '\t' : ' ';
}

std::vector<std::string_view> split_fields(std::string_view line, char separator) {
  if (separator == ' ') {
    std::vector<std::string_view> words = split_words(line);
    std::ranges::transform(words, words.begin(), bare);
    return words;
  }
  line = separator == '\t' ? line.substr(0, line.find_last_not_of("\r\n") + 1) : without_blanks(line);
  std::vector<std::string_view> fields;
  for (std::size_t end = line.find(separator); end != std::string_view::npos; end = line.find(separator)) {
    fields.push_back(bare(line.substr(0, end)));
    line.remove_prefix(end + 1);
  }
  fields.push_back(bare(line));
  return fields;
}

std::optional<PoseLayout> layout_of_header(const std::string& header, char separator) {
  const std::string joined = with_units_joined(header);
  std::optional<PoseLayout> layout = layout_of_names(joined, separator);
  return layout || separator == ' ' ? layout : layout_of_names(joined, ' ');
}

std::optional<PoseLayout> layout_of_columns(std::size_t num_columns) {
  PoseLayout layout;
  layout.num_columns = num_columns;
  layout.is_matrix = num_columns == kMatrixColumns || num_columns == kSquareMatrixColumns;
  if (layout.is_matrix) return layout;
  if (num_columns != kTumColumns) return std::nullopt;
  layout.time = 0;
  for (std::size_t i = 0; i < layout.columns.size(); ++i) layout.columns[i] = i + 1;
  return layout;
}

}  // namespace vdbmap
