// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/kitti/label_file.h"

#include <string>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/file/scalar_type.h"

namespace vdbmap {

std::vector<PointLabel> read_labels(const std::filesystem::path& path) {
  ByteReader reader(path);
  if (reader.remaining() % sizeof(std::uint32_t) != 0) reader.fail("the size is not a multiple of four bytes");
  std::vector<PointLabel> labels(reader.remaining() / sizeof(std::uint32_t));
  for (PointLabel& point : labels) {
    point.label = reader.read_le<std::uint16_t>();
    point.object = reader.read_le<std::uint16_t>();
  }
  return labels;
}

void attach_labels(ReadResult& read, const std::filesystem::path& path) {
  const std::vector<PointLabel> labels = read_labels(path);
  const std::size_t num_points = read.cloud.size() + read.dropped.size();
  if (labels.size() != num_points) {
    throw IoError::malformed(
        path, "has labels of " + std::to_string(labels.size()) + " points, the scan has " + std::to_string(num_points));
  }
  read.cloud.labels.clear();
  read.cloud.labels.reserve(read.cloud.size());
  auto next_dropped = read.dropped.begin();
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (next_dropped != read.dropped.end() && *next_dropped == i) {
      ++next_dropped;
    } else {
      read.cloud.labels.push_back(labels[i].label);
    }
  }
  read.label_scheme = LabelScheme::kSemanticKitti;
}

void write_labels(const std::filesystem::path& path, const std::vector<PointLabel>& labels) {
  std::string bytes;
  bytes.reserve(labels.size() * sizeof(std::uint32_t));
  for (const PointLabel& point : labels) {
    append_binary(bytes, point.label, ScalarType::kUint16);
    append_binary(bytes, point.object, ScalarType::kUint16);
  }
  write_file(path, bytes);
}

}  // namespace vdbmap
