// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/table/xyz_header.h"

#include <algorithm>
#include <array>

#include "vdbmap/io/file/text.h"
#include "vdbmap/io/points/point_fields.h"

namespace vdbmap {
namespace {

constexpr std::string_view kMarks = "#/;%! \t";

std::string_view without_marks(std::string_view line) {
  const std::size_t begin = std::min(line.find_first_not_of(kMarks), line.size());
  return line.substr(begin);
}

// "columns: x y z" is "x y z", "Points:0,Points:1" is not "0,Points:1".
std::string_view without_title(std::string_view line) {
  const std::size_t colon = line.find(": ");
  const bool is_title = colon != std::string_view::npos && colon < line.find_first_of(",;|\t\" ");
  return is_title ? line.substr(colon + 2) : line;
}

// Between blanks a unit is a word of its own: "x [m] y [m] z [m]".
void append_name(std::vector<std::string>& names, std::string_view cell) {
  const bool is_unit = cell.starts_with('[') || cell.starts_with('(');
  if (is_unit && !names.empty()) {
    names.back() += cell;
  } else {
    names.emplace_back(cell);
  }
}

XyzHeader split(std::string_view line, const TableFormat& format) {
  XyzHeader header;
  for (const std::string_view cell : split_cells(line, format)) append_name(header.names, cell);
  return header;
}

}  // namespace

bool XyzHeader::names_coordinates() const {
  std::vector<NamedField> fields;
  for (const std::string& name : names) fields.push_back({name, ScalarType::kFloat64});
  return names.size() <= kMostColumns && !missing_coordinate(choose_point_fields(fields));
}

bool XyzHeader::names_angles() const {
  return std::ranges::count_if(names, [](const std::string& name) { return is_geographic_name(name); }) >= 2;
}

bool XyzHeader::is_sentence() const {
  static constexpr std::array<std::string_view, 12> kWords = {"are", "is", "in", "of",   "the", "and",
                                                              "as",  "by", "to", "with", "for", "from"};
  return std::ranges::any_of(names, [](const std::string& name) {
    return std::ranges::find(kWords, std::string_view(lower_case(name))) != kWords.end();
  });
}

bool is_marked_comment(std::string_view line) {
  const std::string_view text = line.substr(std::min(line.find_first_not_of(" \t"), line.size()));
  return text.starts_with("//") ||
         (!text.empty() && std::string_view("#;%!").find(text.front()) != std::string_view::npos);
}

XyzHeader split_header(std::string_view line, const TableFormat& format) {
  const std::string_view text = without_title(without_marks(line));
  XyzHeader header = split(text, format);
  for (const char separator : {',', ';', '\t', '|', ' '}) {
    if (header.names_coordinates()) break;
    XyzHeader other = split(text, {separator, false});
    if (other.names_coordinates() || header.names.size() == 1) header = std::move(other);
  }
  header.is_comment = is_marked_comment(line);
  return header;
}

}  // namespace vdbmap
