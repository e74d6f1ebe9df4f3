// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/table/missing_values.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vdbmap/io/file/text.h"

namespace vdbmap {
namespace {

bool is_mark_of_nothing(std::string_view text) {
  static constexpr std::array<std::string_view, 10> kMarks = {"",     "-",    "--",   "n/a", "na",
                                                              "#n/a", "none", "null", "?",   "*"};
  return std::ranges::find(kMarks, std::string_view(lower_case(text))) != kMarks.end();
}

void remove_attribute(PointCloud& cloud, FieldRole role) {
  switch (role) {
    case FieldRole::kX:
    case FieldRole::kY:
    case FieldRole::kZ:
      return;
    case FieldRole::kRed:
    case FieldRole::kGreen:
    case FieldRole::kBlue:
    case FieldRole::kPackedRgb:
      return cloud.colors.clear();
    case FieldRole::kIntensity:
      return cloud.intensities.clear();
    case FieldRole::kTime:
      return cloud.times.clear();
    case FieldRole::kRing:
      return cloud.rings.clear();
    case FieldRole::kLabel:
      return cloud.labels.clear();
  }
}

bool is_whole_below(double number, double end) { return number >= 0 && number < end && number == std::floor(number); }

}  // namespace

void MissingValues::add(std::size_t field, std::uint64_t line, std::string_view text, const std::string& reason) {
  OfField& missing = of_field_[field];
  if (missing.count++ == 0) missing.first = "line " + std::to_string(line) + ": " + reason;
  missing.has_damage = missing.has_damage || !is_mark_of_nothing(text);
}

void MissingValues::finish(PointCloud& cloud, const std::vector<std::optional<PointField>>& fields,
                           const std::vector<std::string>& names, std::vector<ReadFinding>& findings) const {
  for (const auto& [field, missing] : of_field_) {
    const bool are_all = missing.count >= cloud.size();
    if (are_all) remove_attribute(cloud, fields[field]->role);
    add_finding(findings, {"values of " + vdbmap::quoted(names[field]) + " left out", missing.count, missing.first,
                           missing.has_damage && !are_all});
  }
}

bool is_possible(const PointField& field, double number) {
  switch (field.role) {
    case FieldRole::kRing:
      return std::isnan(number) || is_whole_below(number, 65536.0);
    case FieldRole::kLabel:
      return std::isnan(number) || is_whole_below(number, 4294967296.0);
    case FieldRole::kRed:
    case FieldRole::kGreen:
    case FieldRole::kBlue:
      return std::isnan(number) || (number >= 0 && number <= 65535);
    default:
      return true;
  }
}

std::string text_of_possible(const PointField& field) {
  if (field.role == FieldRole::kRing) return "a whole number from 0 to 65535";
  if (field.role == FieldRole::kLabel) return "a whole number from 0 to 2^32-1";
  return is_color_channel(field.role) ? "a number from 0 to 65535" : "a number";
}

}  // namespace vdbmap
