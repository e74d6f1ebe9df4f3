// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/xyz_layout.h"

#include <algorithm>
#include <cctype>
#include <string>

namespace vdbmap {
namespace {

// More are no table of points, and would take memory out of proportion to the file.
constexpr std::size_t kMostColumns = 1000;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }
bool is_separator(char c) { return c == ',' || c == ';'; }

void skip_blanks(std::string_view& rest) {
  while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
}

bool is_comment(std::string_view rest) { return rest.starts_with('#') || rest.starts_with("//"); }

std::string_view without_comment_marker(std::string_view line) {
  skip_blanks(line);
  while (line.starts_with('#') || line.starts_with('/')) line.remove_prefix(1);
  return line;
}

// A name as choose_point_fields() knows it, with the type that gives its numbers the right scale.
NamedField named_field(std::string_view column) {
  std::string name;
  for (const char c : column) {
    if (c != '"') name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  if (name == "laser_number") return {"ring", ScalarType::kUint16};
  if (name == "offset_ns") return {"t", ScalarType::kInt64};
  if (name == "r16" || name == "g16" || name == "b16") return {name.substr(0, 1), ScalarType::kUint16};
  return {name, ScalarType::kFloat64};
}

bool is_color_channel(const PointField& field) {
  return field.role == FieldRole::kRed || field.role == FieldRole::kGreen || field.role == FieldRole::kBlue;
}

XyzLayout layout_of(const std::vector<NamedField>& fields) {
  XyzLayout layout;
  layout.columns = choose_point_fields(fields);
  for (std::optional<PointField>& field : layout.columns) {
    if (!field || !is_color_channel(*field)) continue;
    layout.colors_have_16_bits = layout.colors_have_16_bits || field->type == ScalarType::kUint16;
    field->scale = 1.0;
  }
  return layout;
}

}  // namespace

std::optional<std::string_view> next_column(std::string_view& rest) {
  skip_blanks(rest);
  if (rest.empty() || is_comment(rest)) return std::nullopt;

  const auto* const end = std::ranges::find_if(rest, [](char c) { return is_blank(c) || is_separator(c); });
  const std::string_view column(rest.begin(), end);
  rest.remove_prefix(column.size());
  skip_blanks(rest);
  if (!rest.empty() && is_separator(rest.front())) rest.remove_prefix(1);
  return column;
}

std::size_t count_columns(std::string_view line) {
  std::size_t count = 0;
  while (next_column(line)) ++count;
  return count;
}

std::optional<XyzLayout> layout_of_header(std::string_view line) {
  std::string_view rest = without_comment_marker(line);
  std::vector<NamedField> fields;
  while (const auto column = next_column(rest)) {
    if (fields.size() == kMostColumns) return std::nullopt;
    fields.push_back(named_field(*column));
  }

  XyzLayout layout = layout_of(fields);
  if (missing_coordinate(layout.columns)) return std::nullopt;
  return layout;
}

std::optional<XyzLayout> layout_of_count(std::size_t num_columns) {
  switch (num_columns) {
    case 3:
      return layout_of_header("x y z");
    case 4:
      return layout_of_header("x y z intensity");
    case 6:
      return layout_of_header("x y z r g b");
    case 7:
      return layout_of_header("x y z intensity r g b");
    default:
      return std::nullopt;
  }
}

}  // namespace vdbmap
