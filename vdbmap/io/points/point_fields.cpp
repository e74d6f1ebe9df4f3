// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/points/point_fields.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <set>
#include <stdexcept>
#include <string_view>

#include "vdbmap/io/file/text.h"
#include "vdbmap/io/points/color_range.h"

namespace vdbmap {
namespace {

// A block of every column fits into the first-level cache, and so do the records it comes from.
constexpr std::size_t kPointsAtOnce = 512;

// The scale of a colour that its type or its name says; nothing where the file's numbers have to.
std::optional<double> stated_color_scale(const KnownName& name, ScalarType type) {
  if (name.states_16_bits) return 1.0;
  return is_integer(type) && size_of(type) == 1 ? std::optional(257.0) : std::nullopt;
}

std::optional<PointField> time_field(const NamedField& field, const KnownName& name) {
  if (name.states_unit || !is_integer(field.type)) return PointField{FieldRole::kTime, field.type, name.unit};
  return lower_case(field.name) == "t" ? std::optional(PointField{FieldRole::kTime, field.type, 1e-9}) : std::nullopt;
}

std::optional<PointField> find_point_field(const NamedField& field) {
  const std::optional<KnownName> name = find_name(field.name);
  if (!name) return std::nullopt;
  if (is_color_channel(name->role)) {
    const std::optional<double> scale = stated_color_scale(*name, field.type);
    return PointField{name->role, field.type, scale.value_or(1.0), scale.has_value()};
  }
  if (name->role == FieldRole::kPackedRgb && size_of(field.type) != 4) return std::nullopt;
  if (name->role == FieldRole::kTime) return time_field(field, *name);
  return PointField{name->role, field.type, name->unit};
}

bool has_role(const std::vector<std::optional<PointField>>& fields, FieldRole role) {
  return std::ranges::any_of(fields, [role](const auto& field) { return field && field->role == role; });
}

// The first set of names that gives all three coordinates.
std::optional<CoordinateNames> whole_coordinates(const std::vector<NamedField>& fields) {
  std::map<CoordinateNames, std::set<FieldRole>> found;
  for (const NamedField& field : fields) {
    const std::optional<KnownName> name = find_name(field.name);
    if (name && is_coordinate(name->role)) found[name->coordinates].insert(name->role);
  }
  const auto whole = std::ranges::find_if(found, [](const auto& set) { return set.second.size() == 3; });
  return whole == found.end() ? std::nullopt : std::optional(whole->first);
}

bool is_of_other_coordinates(const NamedField& field, const std::optional<CoordinateNames>& chosen) {
  const std::optional<KnownName> name = find_name(field.name);
  return chosen && name && is_coordinate(name->role) && name->coordinates != *chosen;
}

// Colour comes from three channels or else from packed ones, never from a part.
bool is_unused_color(const std::vector<std::optional<PointField>>& fields, FieldRole role) {
  const bool has_channels =
      has_role(fields, FieldRole::kRed) && has_role(fields, FieldRole::kGreen) && has_role(fields, FieldRole::kBlue);
  return has_channels ? role == FieldRole::kPackedRgb : is_color_channel(role);
}

// Rounds to the nearest 16-bit number; NaN becomes 0.
std::uint16_t saturate(double number) {
  if (!(number > 0)) return 0;
  return number < 65535.0 ? static_cast<std::uint16_t>(number + 0.5) : std::uint16_t{65535};
}

// As in .label files, where the class is in the lower half of 32 bits and the thing's own number in the upper one.
std::uint16_t label_of(double number) {
  const bool has_upper_half = number > 65535.0 && number < 4294967296.0;
  return has_upper_half ? static_cast<std::uint16_t>(static_cast<std::uint32_t>(number) & 0xffff) : saturate(number);
}

Rgb16 unpack_rgb(double number) {
  const bool fits = number >= 0 && number < 4294967296.0;
  const std::uint32_t bits = fits ? static_cast<std::uint32_t>(number) : 0;
  const auto channel = [bits](int shift) { return static_cast<std::uint16_t>((bits >> shift & 0xff) * 257); };
  return {channel(16), channel(8), channel(0)};
}

// The columns, with the scale that all of their colours say.
std::vector<PointColumn> with_color_scale(std::vector<PointColumn> columns, std::size_t num_points) {
  ColorRange range;
  std::array<double, kPointsAtOnce> block;
  for (const PointColumn& column : columns) {
    if (column.field.scale_is_known) continue;
    for (std::size_t first = 0; first < num_points; first += kPointsAtOnce) {
      const std::span<double> numbers(block.data(), std::min(kPointsAtOnce, num_points - first));
      load_numbers(column.numbers, first, numbers);
      range.add(numbers);
    }
  }
  for (PointColumn& column : columns) set_color_scale(column.field, range);
  return columns;
}

}  // namespace

std::vector<std::optional<PointField>> choose_point_fields(const std::vector<NamedField>& fields) {
  const std::optional<CoordinateNames> coordinates = whole_coordinates(fields);
  std::vector<std::optional<PointField>> chosen;
  for (const NamedField& field : fields) {
    std::optional<PointField> candidate = find_point_field(field);
    const bool is_surplus = candidate && has_role(chosen, candidate->role);
    if (is_surplus || is_of_other_coordinates(field, coordinates)) candidate.reset();
    chosen.push_back(candidate);
  }

  const std::vector<std::optional<PointField>> candidates = chosen;
  for (std::optional<PointField>& field : chosen) {
    if (field && is_unused_color(candidates, field->role)) field.reset();
  }
  return chosen;
}

std::optional<std::string> missing_coordinate(const std::vector<std::optional<PointField>>& fields) {
  if (!has_role(fields, FieldRole::kX)) return "x";
  if (!has_role(fields, FieldRole::kY)) return "y";
  if (!has_role(fields, FieldRole::kZ)) return "z";
  return std::nullopt;
}

void check_columns(const std::vector<std::string>& columns) {
  static constexpr std::array<std::string_view, 6> kPassedOver = {"-", "_", "skip", "nx", "ny", "nz"};
  std::vector<NamedField> fields;
  for (const std::string& name : columns) {
    fields.push_back({name, ScalarType::kFloat64});
    if (find_name(name) || std::ranges::find(kPassedOver, name) != kPassedOver.end()) continue;
    throw std::invalid_argument("column " + vdbmap::quoted(name) +
                                " is unknown, expected x y z r g b r16 g16 b16 intensity time ring label, or - for a "
                                "column that is passed over");
  }
  if (const auto missing = missing_coordinate(choose_point_fields(fields)); missing && !columns.empty()) {
    throw std::invalid_argument("the columns have no " + *missing);
  }
}

PointCloud make_cloud(const std::vector<std::optional<PointField>>& fields, std::size_t count) {
  PointCloud cloud;
  cloud.positions.resize(count);
  if (has_role(fields, FieldRole::kPackedRgb) || has_role(fields, FieldRole::kRed)) cloud.colors.resize(count);
  if (has_role(fields, FieldRole::kIntensity)) cloud.intensities.resize(count);
  if (has_role(fields, FieldRole::kTime)) cloud.times.resize(count);
  if (has_role(fields, FieldRole::kRing)) cloud.rings.resize(count);
  if (has_role(fields, FieldRole::kLabel)) cloud.labels.resize(count);
  return cloud;
}

void store_numbers(PointCloud& cloud, const PointField& field, std::size_t first, std::span<const double> numbers) {
  const auto store = [&](auto&& destination_of) {
    for (std::size_t i = 0; i < numbers.size(); ++i) destination_of(first + i, numbers[i] * field.scale);
  };
  switch (field.role) {
    case FieldRole::kX:
      return store([&](std::size_t i, double number) { cloud.positions[i].x() = number; });
    case FieldRole::kY:
      return store([&](std::size_t i, double number) { cloud.positions[i].y() = number; });
    case FieldRole::kZ:
      return store([&](std::size_t i, double number) { cloud.positions[i].z() = number; });
    case FieldRole::kRed:
      return store([&](std::size_t i, double number) { cloud.colors[i].r = saturate(number); });
    case FieldRole::kGreen:
      return store([&](std::size_t i, double number) { cloud.colors[i].g = saturate(number); });
    case FieldRole::kBlue:
      return store([&](std::size_t i, double number) { cloud.colors[i].b = saturate(number); });
    case FieldRole::kPackedRgb:
      return store([&](std::size_t i, double number) { cloud.colors[i] = unpack_rgb(number); });
    case FieldRole::kIntensity:
      return store([&](std::size_t i, double number) { cloud.intensities[i] = static_cast<float>(number); });
    case FieldRole::kTime:
      return store([&](std::size_t i, double number) { cloud.times[i] = number; });
    case FieldRole::kRing:
      return store([&](std::size_t i, double number) { cloud.rings[i] = saturate(number); });
    case FieldRole::kLabel:
      return store([&](std::size_t i, double number) { cloud.labels[i] = label_of(number); });
  }
}

void store_columns(PointCloud& cloud, const std::vector<PointColumn>& columns) {
  const std::vector<PointColumn> scaled = with_color_scale(columns, cloud.size());
  std::array<double, kPointsAtOnce> block;
  for (std::size_t first = 0; first < cloud.size(); first += kPointsAtOnce) {
    const std::span<double> numbers(block.data(), std::min(kPointsAtOnce, cloud.size() - first));
    for (const PointColumn& column : scaled) {
      load_numbers(column.numbers, first, numbers);
      store_numbers(cloud, column.field, first, numbers);
    }
  }
}

ScalarType type_to_load(const PointField& field) {
  return field.role == FieldRole::kPackedRgb ? ScalarType::kUint32 : field.type;
}

double number_from_text(const PointField& field, double number) {
  if (field.role != FieldRole::kPackedRgb || is_integer(field.type)) return number;
  return std::bit_cast<std::uint32_t>(static_cast<float>(number));
}

}  // namespace vdbmap
