// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/table/xyz_layout.h"

#include <algorithm>
#include <cmath>

#include "vdbmap/io/file/text.h"

namespace vdbmap {
namespace {

bool is_plain_whole(std::string_view cell) {
  if (cell.starts_with('-') || cell.starts_with('+')) cell.remove_prefix(1);
  return !cell.empty() && std::ranges::all_of(cell, [](char c) { return c >= '0' && c <= '9'; });
}

bool all_rows(const TableSample& sample, auto&& holds) { return std::ranges::all_of(sample.rows, holds); }

// Nobody knows the unit of a whole number; a fraction is of seconds.
bool has_unknown_unit(const std::string& name, const PointField& field, std::size_t column, const TableSample& sample) {
  const std::optional<KnownName> known = find_name(name);
  if (field.role != FieldRole::kTime || !known || known->states_unit || known->states_seconds) return false;
  return all_rows(sample, [&](const auto& cells) { return column >= cells.size() || is_plain_whole(cells[column]); });
}

// Fractions are what their spelling says: "1.0" is full light, "1" next to none.
ScalarType type_of_column(std::size_t column, const TableSample& sample) {
  const bool are_whole =
      all_rows(sample, [&](const auto& cells) { return column >= cells.size() || is_plain_whole(cells[column]); });
  return are_whole ? ScalarType::kInt64 : ScalarType::kFloat64;
}

std::optional<double> number_at(const std::vector<std::string_view>& cells, std::size_t column,
                                const TableFormat& format) {
  return column < cells.size() ? cell_number(cells[column], format) : std::nullopt;
}

bool is_channel(const std::optional<double>& number) {
  return number && *number >= 0 && *number <= 65535 && *number == std::floor(*number);
}

// Whether three columns can be a colour: whole numbers, all written in one way.
bool can_be_color(const TableSample& sample, std::size_t first) {
  if (first + 3 > sample.num_columns) return false;
  const bool is_plain = is_plain_whole(sample.rows.front()[first]);
  return all_rows(sample, [&](const auto& cells) {
    for (std::size_t i = first; i < first + 3; ++i) {
      if (!is_channel(number_at(cells, i, sample.format)) || is_plain_whole(cells[i]) != is_plain) return false;
    }
    return true;
  });
}

// Whether three columns have length 1, to the two digits that some programs write.
bool can_be_normal(const TableSample& sample, std::size_t first) {
  constexpr double kTolerance = 0.02;
  if (first + 3 > sample.num_columns) return false;
  return all_rows(sample, [&](const auto& cells) {
    double sum = 0;
    for (std::size_t i = first; i < first + 3; ++i) {
      const std::optional<double> number = number_at(cells, i, sample.format);
      if (!number) return false;
      sum += *number * *number;
    }
    return std::abs(std::sqrt(sum) - 1) <= kTolerance;
  });
}

using Names = std::vector<std::string>;

// The names of the columns behind x, y and z; nothing where none or several orders fit.
std::optional<Names> names_of_rest(const TableSample& sample, bool is_leica) {
  const std::size_t width = sample.num_columns;
  if (width == 3) return Names{};
  if (width == 4) return Names{"intensity"};
  const bool is_color = can_be_color(sample, 3) && !(is_leica && width == 7);
  const bool is_normal = can_be_normal(sample, 3);
  const bool is_color_behind_intensity = can_be_color(sample, 4) && (width == 7 || can_be_normal(sample, 7));
  const bool is_color_behind_normal = is_normal && can_be_color(sample, 6);
  if (width == 6 && is_normal != is_color) return is_color ? Names{"r", "g", "b"} : Names{"-", "-", "-"};
  if (width < 7) return std::nullopt;
  if (width == 9 && is_color_behind_normal && !is_color) return Names{"-", "-", "-", "r", "g", "b"};
  if (is_color_behind_intensity && !is_color && (width == 7 || width == 10)) return Names{"intensity", "r", "g", "b"};
  const bool is_color_elsewhere = can_be_color(sample, 4) || is_color_behind_normal;
  if (is_color && !is_color_elsewhere) return Names{"r", "g", "b"};
  return std::nullopt;
}

std::string text_of(const Names& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " ") + name;
  return text;
}

}  // namespace

XyzLayout layout_of_names(const Names& names, const TableSample& sample) {
  std::vector<NamedField> fields;
  for (const std::string& name : names) fields.push_back({name, ScalarType::kFloat64});
  XyzLayout layout{choose_point_fields(fields), names};
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::optional<PointField>& field = layout.columns[i];
    if (!field) continue;
    if (is_color_channel(field->role)) field->type = type_of_column(i, sample);
    if (is_coordinate(field->role) && field->scale != 1.0)
      layout.note = "coordinates turned into metres from the unit that their names state";
  }
  return layout;
}

void leave_out_times_of_no_unit(XyzLayout& layout, const TableSample& sample) {
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    std::optional<PointField>& field = layout.columns[i];
    if (!field || !has_unknown_unit(layout.names[i], *field, i, sample)) continue;
    field.reset();
    layout.note = "times left out: whole numbers of no stated unit in column " + vdbmap::quoted(layout.names[i]);
  }
}

std::optional<XyzLayout> layout_of_values(const TableSample& sample, bool is_leica) {
  const std::optional<Names> rest = names_of_rest(sample, is_leica);
  if (!rest) return std::nullopt;
  Names names = {"x", "y", "z"};
  names.insert(names.end(), rest->begin(), rest->end());
  names.resize(sample.num_columns, "-");
  XyzLayout layout = layout_of_names(names, sample);
  const bool is_plain = names.size() <= 4 || names == Names{"x", "y", "z", "r", "g", "b"};
  if (!is_plain) layout.note = "columns without names are taken for " + text_of(names);
  return layout;
}

}  // namespace vdbmap
