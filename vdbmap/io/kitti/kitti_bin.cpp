// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/kitti/kitti_bin.h"

#include <string>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/file/scalar_type.h"
#include "vdbmap/io/kitti/bin_layout.h"
#include "vdbmap/io/points/point_cloud_check.h"
#include "vdbmap/io/points/point_cloud_filter.h"

namespace vdbmap {
namespace {

BinLayout layout_of(const ByteReader& file, const std::vector<std::string>& columns, std::optional<ScalarType> type) {
  if (!columns.empty()) return bin_layout_of_names(columns, type.value_or(ScalarType::kFloat32));
  if (const auto guessed = guess_bin_layout(file.all(), type)) return *guessed;
  throw IoError::malformed(file.path(), "its " + std::to_string(file.size()) +
                                            " bytes are not plainly points of 3 to 6 numbers each; name the numbers of "
                                            "a point, as in --bin-columns x,y,z,intensity,ring");
}

PointCloud read_kitti_points(const char* from, std::size_t num_points) {
  PointCloud cloud;
  cloud.positions.resize(num_points);
  cloud.intensities.resize(num_points);
  for (std::size_t i = 0; i < num_points; ++i, from += 16) {
    cloud.positions[i] = {load<float>(from), load<float>(from + 4), load<float>(from + 8)};
    cloud.intensities[i] = load<float>(from + 12);
  }
  return cloud;
}

PointCloud read_points_of(const BinLayout& layout, const char* from, std::size_t num_points) {
  if (layout.is_kitti()) return read_kitti_points(from, num_points);
  std::vector<PointColumn> columns;
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    if (!layout.columns[i]) continue;
    columns.push_back({*layout.columns[i], {from + i * size_of(layout.type), layout.point_size(), layout.type}});
  }
  PointCloud cloud = make_cloud(layout.columns, num_points);
  store_columns(cloud, columns);
  return cloud;
}

std::vector<ReadFinding> findings_of(const ByteReader& file, const BinLayout& layout, bool is_guessed) {
  std::vector<ReadFinding> findings;
  if (is_guessed && !layout.is_kitti()) {
    findings.push_back({"a point is taken for " + text_of(layout) + ", not for KITTI's x, y, z, intensity"});
  }
  if (const std::uint64_t left = file.size() % layout.point_size(); left > 0) {
    findings.push_back({"bytes of a point that the end of the file cuts off", left, "", true});
  }
  return findings;
}

}  // namespace

ReadResult read_kitti_bin(const std::filesystem::path& path, const std::vector<std::string>& columns,
                          std::optional<ScalarType> type) {
  check_columns(columns);
  ByteReader file(path);
  if (file.size() == 0) return finish_reading(path, {});
  const BinLayout layout = layout_of(file, columns, type);
  const std::size_t num_points = file.size() / layout.point_size();
  PointCloud cloud = read_points_of(layout, file.all().data(), num_points);
  return finish_reading(path, std::move(cloud), {}, findings_of(file, layout, columns.empty()));
}

void write_kitti_bin(const std::filesystem::path& path, const PointCloud& cloud) {
  check_writable_cloud(cloud);
  AtomicFile file(path);
  std::string record;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    record.clear();
    for (const double coordinate : cloud.positions[i]) append_binary(record, coordinate, ScalarType::kFloat32);
    append_binary(record, cloud.intensities.empty() ? 0.0f : cloud.intensities[i], ScalarType::kFloat32);
    file.write(record);
  }
  file.commit();
}

}  // namespace vdbmap
