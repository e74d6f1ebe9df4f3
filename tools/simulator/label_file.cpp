// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/label_file.h"

#include <string>

#include "vdbmap/io/atomic_file.h"
#include "vdbmap/io/byte_reader.h"
#include "vdbmap/io/scalar_type.h"

namespace vdbmap::simulator {

void write_labels(const std::filesystem::path& path, const std::vector<PointTruth>& truth) {
  std::string bytes;
  bytes.reserve(truth.size() * sizeof(std::uint32_t));
  for (const PointTruth& point : truth) {
    append_binary(bytes, point.label, ScalarType::kUint16);
    append_binary(bytes, point.object, ScalarType::kUint16);
  }
  write_file(path, bytes);
}

std::vector<PointTruth> read_labels(const std::filesystem::path& path) {
  ByteReader reader(path);
  if (reader.remaining() % sizeof(std::uint32_t) != 0) reader.fail("the size is not a multiple of four bytes");
  std::vector<PointTruth> truth(reader.remaining() / sizeof(std::uint32_t));
  for (PointTruth& point : truth) {
    point.label = reader.read_le<std::uint16_t>();
    point.object = reader.read_le<std::uint16_t>();
  }
  return truth;
}

}  // namespace vdbmap::simulator
