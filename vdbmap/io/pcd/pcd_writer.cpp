// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/io/pcd/lzf.h"
#include "vdbmap/io/pcd/pcd.h"
#include "vdbmap/io/points/point_cloud_check.h"
#include "vdbmap/io/points/point_encoder.h"

namespace vdbmap {
namespace {

bool is_exact_in_float(const Eigen::Vector3d& position) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  return position.cwiseAbs().maxCoeff() <= kLargest && position.cast<float>().cast<double>() == position;
}

std::vector<OutputField> choose_output(const PointCloud& cloud, PcdEncoding encoding) {
  const bool is_float = std::ranges::all_of(cloud.positions, is_exact_in_float);
  const ScalarType type = is_float ? ScalarType::kFloat32 : ScalarType::kFloat64;
  std::vector<OutputField> fields = {
      {"x", {FieldRole::kX, type}}, {"y", {FieldRole::kY, type}}, {"z", {FieldRole::kZ, type}}};
  // PCL packs colours into the bits of a float, and prints those bits as an integer.
  const ScalarType rgb_type = encoding == PcdEncoding::kAscii ? ScalarType::kUint32 : ScalarType::kFloat32;
  if (!cloud.colors.empty()) fields.push_back({"rgb", {FieldRole::kPackedRgb, rgb_type}});
  for (const OutputField& field : scalar_fields(cloud)) fields.push_back(field);
  return fields;
}

const char* type_letter(ScalarType type) { return is_integer(type) ? "U" : "F"; }

std::string header_text(const std::vector<OutputField>& fields, std::size_t num_points, PcdEncoding encoding) {
  std::string names, sizes, types, counts;
  for (const OutputField& output : fields) {
    names.append(" ").append(output.name);
    sizes.append(" ").append(std::to_string(size_of(output.field.type)));
    types.append(" ").append(type_letter(output.field.type));
    counts.append(" 1");
  }
  const std::string count = std::to_string(num_points);
  const std::string data = encoding == PcdEncoding::kAscii    ? "ascii"
                           : encoding == PcdEncoding::kBinary ? "binary"
                                                              : "binary_compressed";
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS" + names + "\nSIZE" + sizes + "\nTYPE" +
         types + "\nCOUNT" + counts + "\nWIDTH " + count + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count +
         "\nDATA " + data + "\n";
}

void check_compressed_size(const PointCloud& cloud, const std::vector<OutputField>& fields) {
  std::uint64_t point_size = 0;
  for (const OutputField& output : fields) point_size += size_of(output.field.type);
  // The format has 32 bits for the size before and after compression, which can add 1/32.
  const std::uint64_t most = (std::uint64_t{1} << 32) / 33 * 32 / point_size;
  if (cloud.size() > most) {
    throw std::invalid_argument("a compressed PCD file holds at most " + std::to_string(most) + " such points, given " +
                                std::to_string(cloud.size()));
  }
}

void write_compressed_points(AtomicFile& file, const PointCloud& cloud, const std::vector<OutputField>& fields) {
  std::string data;
  for (const OutputField& output : fields) {
    for (std::size_t point = 0; point < cloud.size(); ++point) {
      append_binary(data, number_of_point(cloud, output.field, point), type_to_load(output.field));
    }
  }
  const std::string compressed = lzf_compress(data);
  std::string sizes;
  append_binary(sizes, static_cast<double>(compressed.size()), ScalarType::kUint32);
  append_binary(sizes, static_cast<double>(data.size()), ScalarType::kUint32);
  file.write(sizes);
  file.write(compressed);
}

}  // namespace

void write_pcd(const std::filesystem::path& path, const PointCloud& cloud, PcdEncoding encoding) {
  check_writable_cloud(cloud);
  const std::vector<OutputField> fields = choose_output(cloud, encoding);
  if (encoding == PcdEncoding::kBinaryCompressed) check_compressed_size(cloud, fields);

  AtomicFile file(path);
  file.write(header_text(fields, cloud.size(), encoding));
  if (encoding == PcdEncoding::kAscii) write_text_points(file, cloud, fields);
  if (encoding == PcdEncoding::kBinary) write_binary_points(file, cloud, fields);
  if (encoding == PcdEncoding::kBinaryCompressed) write_compressed_points(file, cloud, fields);
  file.commit();
}

}  // namespace vdbmap
