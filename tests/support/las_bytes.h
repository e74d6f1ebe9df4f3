// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace vdbmap::test {

/// Appends a number of `size` bytes, little endian; a double takes 8.
void put(std::string& bytes, std::uint64_t value, int size);
void put(std::string& bytes, double value);

/// A point as a LAS file stores it.
struct LasPoint {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;
  std::uint16_t intensity = 0;
  std::uint8_t classification = 0;
  double time = 0;
  std::uint16_t red = 0;
  std::uint16_t green = 0;
  std::uint16_t blue = 0;
  std::uint8_t flags = 0;  ///< of formats from 6 on, where they have a byte of their own
};

/// A variable length record.
struct LasBytesRecord {
  std::string user;
  std::uint16_t id = 0;
  std::string data;
};

/// A LAS file byte for byte after the specification, independent of the library's writer. What stands in the header may
/// be made to lie by overwriting bytes of the result.
struct LasBytes {
  unsigned minor_version = 2;
  unsigned format = 0;
  std::uint16_t global_encoding = 0;
  std::size_t num_extra_bytes = 0;  ///< a point
  Eigen::Vector3d scale{0.01, 0.02, 0.5};
  Eigen::Vector3d offset{500000, 5800000, -100};
  std::vector<LasPoint> points;
  std::vector<LasBytesRecord> records;
  std::vector<LasBytesRecord> extended_records;

  /// From version 1.4 on the counts are those of 64 bits, and the legacy counts 0.
  std::string bytes() const;
};

/// The data of record 34735: keys with the values they hold themselves.
std::string geo_keys(const std::vector<std::pair<std::uint16_t, std::uint16_t>>& keys);

}  // namespace vdbmap::test
