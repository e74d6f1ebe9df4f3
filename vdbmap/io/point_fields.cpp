// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/point_fields.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstdint>
#include <string_view>
#include <unordered_map>

namespace vdbmap {
namespace {

// A block of every column fits into the first-level cache, and so do the records it comes from.
constexpr std::size_t kPointsAtOnce = 512;

std::optional<FieldRole> find_role(const std::string& name) {
  static const std::unordered_map<std::string_view, FieldRole> kRoles = {
      {"x", FieldRole::kX},
      {"y", FieldRole::kY},
      {"z", FieldRole::kZ},
      {"red", FieldRole::kRed},
      {"r", FieldRole::kRed},
      {"diffuse_red", FieldRole::kRed},
      {"green", FieldRole::kGreen},
      {"g", FieldRole::kGreen},
      {"diffuse_green", FieldRole::kGreen},
      {"blue", FieldRole::kBlue},
      {"b", FieldRole::kBlue},
      {"diffuse_blue", FieldRole::kBlue},
      {"rgb", FieldRole::kPackedRgb},
      {"rgba", FieldRole::kPackedRgb},
      {"intensity", FieldRole::kIntensity},
      {"i", FieldRole::kIntensity},
      {"reflectance", FieldRole::kIntensity},
      {"reflectivity", FieldRole::kIntensity},
      {"remission", FieldRole::kIntensity},
      {"time", FieldRole::kTime},
      {"timestamp", FieldRole::kTime},
      {"time_stamp", FieldRole::kTime},
      {"gps_time", FieldRole::kTime},
      {"gpstime", FieldRole::kTime},
      {"t", FieldRole::kTime},
      {"ring", FieldRole::kRing},
      {"channel", FieldRole::kRing},
      {"laser_id", FieldRole::kRing},
      {"label", FieldRole::kLabel},
      {"classification", FieldRole::kLabel},
      {"class", FieldRole::kLabel},
      {"semantic", FieldRole::kLabel},
  };
  const auto found = kRoles.find(name);
  return found == kRoles.end() ? std::nullopt : std::optional(found->second);
}

std::string normalized(const std::string& name) {
  std::string lower;
  for (const char c : name) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower.starts_with("scalar_") ? lower.substr(7) : lower;
}

bool is_color_channel(FieldRole role) {
  return role == FieldRole::kRed || role == FieldRole::kGreen || role == FieldRole::kBlue;
}

double color_scale(ScalarType type) {
  if (!is_integer(type)) return 65535.0;
  return size_of(type) == 2 ? 1.0 : 257.0;
}

std::optional<PointField> find_point_field(const NamedField& field) {
  const std::string name = normalized(field.name);
  const std::optional<FieldRole> role = find_role(name);
  if (!role) return std::nullopt;
  if (is_color_channel(*role)) return PointField{*role, field.type, color_scale(field.type)};
  if (*role == FieldRole::kPackedRgb && size_of(field.type) != 4) return std::nullopt;
  if (*role == FieldRole::kTime && is_integer(field.type)) {
    return name == "t" ? std::optional(PointField{*role, field.type, 1e-9}) : std::nullopt;
  }
  return PointField{*role, field.type};
}

bool has_role(const std::vector<std::optional<PointField>>& fields, FieldRole role) {
  return std::ranges::any_of(fields, [role](const auto& field) { return field && field->role == role; });
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

}  // namespace

std::vector<std::optional<PointField>> choose_point_fields(const std::vector<NamedField>& fields) {
  std::vector<std::optional<PointField>> chosen;
  for (const NamedField& field : fields) {
    std::optional<PointField> candidate = find_point_field(field);
    if (candidate && has_role(chosen, candidate->role)) candidate.reset();
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
  std::array<double, kPointsAtOnce> block;
  for (std::size_t first = 0; first < cloud.size(); first += kPointsAtOnce) {
    const std::span<double> numbers(block.data(), std::min(kPointsAtOnce, cloud.size() - first));
    for (const PointColumn& column : columns) {
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
