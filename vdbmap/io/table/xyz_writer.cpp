// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>
#include <vector>

#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/io/points/point_cloud_check.h"
#include "vdbmap/io/points/point_encoder.h"
#include "vdbmap/io/table/xyz.h"

namespace vdbmap {
namespace {

std::vector<OutputField> choose_output(const PointCloud& cloud) {
  std::vector<OutputField> fields = {{"x", {FieldRole::kX, ScalarType::kFloat64}},
                                     {"y", {FieldRole::kY, ScalarType::kFloat64}},
                                     {"z", {FieldRole::kZ, ScalarType::kFloat64}}};
  for (const OutputField& field : scalar_fields(cloud)) fields.push_back(field);
  if (cloud.colors.empty()) return fields;

  const bool is_short = has_8_bit_colors(cloud);
  const ScalarType type = is_short ? ScalarType::kUint8 : ScalarType::kUint16;
  const double scale = is_short ? 257.0 : 1.0;
  fields.push_back({is_short ? "r" : "r16", {FieldRole::kRed, type, scale}});
  fields.push_back({is_short ? "g" : "g16", {FieldRole::kGreen, type, scale}});
  fields.push_back({is_short ? "b" : "b16", {FieldRole::kBlue, type, scale}});
  return fields;
}

std::string header_line(const std::vector<OutputField>& fields) {
  std::string line = "#";
  for (const OutputField& output : fields) line += " " + output.name;
  return line + "\n";
}

}  // namespace

void write_xyz(const std::filesystem::path& path, const PointCloud& cloud) {
  check_writable_cloud(cloud);
  const std::vector<OutputField> fields = choose_output(cloud);

  AtomicFile file(path);
  file.write(header_line(fields));
  write_text_points(file, cloud, fields);
  file.commit();
}

}  // namespace vdbmap
