// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/kitti_bin.h"

#include <string>
#include <utility>

#include "vdbmap/io/atomic_file.h"
#include "vdbmap/io/byte_reader.h"
#include "vdbmap/io/point_cloud_check.h"
#include "vdbmap/io/point_cloud_filter.h"
#include "vdbmap/io/scalar_type.h"

namespace vdbmap {
namespace {

constexpr std::size_t kPointSize = 16;  // [bytes]

}  // namespace

ReadResult read_kitti_bin(const std::filesystem::path& path) {
  ByteReader reader(path);
  const std::size_t num_points = reader.size() / kPointSize;
  const char* from = reader.bytes(num_points * kPointSize).data();
  if (reader.remaining() > 0) {
    reader.fail("the file ends within a point: " + std::to_string(reader.size()) + " bytes are not a multiple of 16");
  }

  PointCloud cloud;
  cloud.positions.resize(num_points);
  cloud.intensities.resize(num_points);
  for (std::size_t i = 0; i < num_points; ++i, from += kPointSize) {
    cloud.positions[i] = {load<float>(from), load<float>(from + 4), load<float>(from + 8)};
    cloud.intensities[i] = load<float>(from + 12);
  }
  return finish_reading(path, std::move(cloud));
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
