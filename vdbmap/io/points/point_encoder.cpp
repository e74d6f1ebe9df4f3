// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/points/point_encoder.h"

#include <algorithm>
#include <cstdint>

namespace vdbmap {
namespace {

std::uint32_t to_8_bits(std::uint16_t channel) { return (channel + 128u) / 257u; }

double pack_rgb(const Rgb16& color) { return to_8_bits(color.r) << 16 | to_8_bits(color.g) << 8 | to_8_bits(color.b); }

double value_of_point(const PointCloud& cloud, FieldRole role, std::size_t point) {
  switch (role) {
    case FieldRole::kX:
      return cloud.positions[point].x();
    case FieldRole::kY:
      return cloud.positions[point].y();
    case FieldRole::kZ:
      return cloud.positions[point].z();
    case FieldRole::kRed:
      return cloud.colors[point].r;
    case FieldRole::kGreen:
      return cloud.colors[point].g;
    case FieldRole::kBlue:
      return cloud.colors[point].b;
    case FieldRole::kPackedRgb:
      return pack_rgb(cloud.colors[point]);
    case FieldRole::kIntensity:
      return cloud.intensities[point];
    case FieldRole::kTime:
      return cloud.times[point];
    case FieldRole::kRing:
      return cloud.rings[point];
    case FieldRole::kLabel:
      return cloud.labels[point];
  }
  return 0;
}

}  // namespace

std::vector<OutputField> scalar_fields(const PointCloud& cloud) {
  std::vector<OutputField> fields;
  if (!cloud.intensities.empty()) fields.push_back({"intensity", {FieldRole::kIntensity, ScalarType::kFloat32}});
  if (!cloud.times.empty()) fields.push_back({"time", {FieldRole::kTime, ScalarType::kFloat64}});
  if (!cloud.rings.empty()) fields.push_back({"ring", {FieldRole::kRing, ScalarType::kUint16}});
  if (!cloud.labels.empty()) fields.push_back({"label", {FieldRole::kLabel, ScalarType::kUint16}});
  return fields;
}

bool has_8_bit_colors(const PointCloud& cloud) {
  return std::ranges::all_of(
      cloud.colors, [](const Rgb16& color) { return color.r % 257 == 0 && color.g % 257 == 0 && color.b % 257 == 0; });
}

double number_of_point(const PointCloud& cloud, const PointField& field, std::size_t point) {
  return value_of_point(cloud, field.role, point) / field.scale;
}

void write_binary_points(AtomicFile& file, const PointCloud& cloud, const std::vector<OutputField>& fields) {
  std::string record;
  for (std::size_t point = 0; point < cloud.size(); ++point) {
    record.clear();
    for (const OutputField& output : fields) {
      append_binary(record, number_of_point(cloud, output.field, point), type_to_load(output.field));
    }
    file.write(record);
  }
}

void write_text_points(AtomicFile& file, const PointCloud& cloud, const std::vector<OutputField>& fields) {
  std::string line;
  for (std::size_t point = 0; point < cloud.size(); ++point) {
    line.clear();
    for (const OutputField& output : fields) {
      if (!line.empty()) line += ' ';
      append_text(line, number_of_point(cloud, output.field, point), output.field.type);
    }
    file.write(line += '\n');
  }
}

}  // namespace vdbmap
