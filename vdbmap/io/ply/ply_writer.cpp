// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <string>

#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/io/ply/ply.h"
#include "vdbmap/io/ply/ply_header.h"
#include "vdbmap/io/points/point_cloud_check.h"
#include "vdbmap/io/points/point_encoder.h"

namespace vdbmap {
namespace {

std::vector<OutputField> choose_output(const PointCloud& cloud) {
  std::vector<OutputField> fields = {{"x", {FieldRole::kX, ScalarType::kFloat64}},
                                     {"y", {FieldRole::kY, ScalarType::kFloat64}},
                                     {"z", {FieldRole::kZ, ScalarType::kFloat64}}};
  if (!cloud.colors.empty()) {
    const bool is_short = has_8_bit_colors(cloud);
    const ScalarType type = is_short ? ScalarType::kUint8 : ScalarType::kUint16;
    const double scale = is_short ? 257.0 : 1.0;
    fields.push_back({"red", {FieldRole::kRed, type, scale}});
    fields.push_back({"green", {FieldRole::kGreen, type, scale}});
    fields.push_back({"blue", {FieldRole::kBlue, type, scale}});
  }
  for (const OutputField& field : scalar_fields(cloud)) fields.push_back(field);
  return fields;
}

std::string ply_name(ScalarType type) {
  constexpr std::array<const char*, 10> kNames = {"char", "uchar", "short",  "ushort", "int",
                                                  "uint", "int64", "uint64", "float",  "double"};
  return kNames[static_cast<std::size_t>(type)];
}

// Of 16 bits, but none above 255: readers take it for one of 8 bits.
bool is_dark(const PointCloud& cloud) {
  const auto is_small = [](const Rgb16& color) { return std::max({color.r, color.g, color.b}) <= 255; };
  return !has_8_bit_colors(cloud) && std::ranges::all_of(cloud.colors, is_small);
}

std::string header_text(const std::vector<OutputField>& fields, const PointCloud& cloud, PlyEncoding encoding) {
  const std::string format = encoding == PlyEncoding::kAscii ? "ascii" : "binary_little_endian";
  std::string text = "ply\nformat " + format + " 1.0\n";
  if (is_dark(cloud)) text += std::string(kPlyComment16Bits) + "\n";
  text += "element vertex " + std::to_string(cloud.size()) + "\n";
  for (const OutputField& output : fields) text += "property " + ply_name(output.field.type) + " " + output.name + "\n";
  return text + "end_header\n";
}

}  // namespace

void write_ply(const std::filesystem::path& path, const PointCloud& cloud, PlyEncoding encoding) {
  check_writable_cloud(cloud);
  const std::vector<OutputField> fields = choose_output(cloud);

  AtomicFile file(path);
  file.write(header_text(fields, cloud, encoding));
  if (encoding == PlyEncoding::kAscii) {
    write_text_points(file, cloud, fields);
  } else {
    write_binary_points(file, cloud, fields);
  }
  file.commit();
}

}  // namespace vdbmap
