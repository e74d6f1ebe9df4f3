// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/las_bytes.h"

#include <array>
#include <bit>

namespace vdbmap::test {

void put(std::string& bytes, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) bytes += static_cast<char>(value >> 8 * i & 0xff);
}

void put(std::string& bytes, double value) { put(bytes, std::bit_cast<std::uint64_t>(value), 8); }

namespace {

void put_padded(std::string& bytes, std::string text, std::size_t size) {
  text.resize(size);
  bytes += text;
}

std::string record_bytes(const LasBytesRecord& record, int size_of_length) {
  std::string bytes;
  put(bytes, 0, 2);
  put_padded(bytes, record.user, 16);
  put(bytes, record.id, 2);
  put(bytes, record.data.size(), size_of_length);
  put_padded(bytes, "made by a test", 32);
  return bytes + record.data;
}

std::string concatenated(const std::vector<LasBytesRecord>& records, int size_of_length) {
  std::string bytes;
  for (const LasBytesRecord& record : records) bytes += record_bytes(record, size_of_length);
  return bytes;
}

// LAS 1.4-R15, tables 7 to 17.
std::string point_bytes(const LasPoint& point, unsigned format) {
  const bool has_time = format == 1 || format >= 3;
  const bool has_color = format == 2 || format == 3 || format == 5 || format == 7 || format == 8;
  const bool has_waveform = format == 4 || format == 5;
  std::string bytes;
  put(bytes, static_cast<std::uint32_t>(point.x), 4);
  put(bytes, static_cast<std::uint32_t>(point.y), 4);
  put(bytes, static_cast<std::uint32_t>(point.z), 4);
  put(bytes, point.intensity, 2);
  put(bytes, 0x11, 1);  // return 1 of 1 or 2
  if (format >= 6) put(bytes, point.flags, 1);
  put(bytes, point.classification, 1);            // up to format 5 with flags in its upper bits
  put(bytes, 0xaaaaaaaaaa, format >= 6 ? 5 : 4);  // user data, scan angle, source
  if (has_time) put(bytes, point.time);
  if (has_color) put(bytes, point.red, 2);
  if (has_color) put(bytes, point.green, 2);
  if (has_color) put(bytes, point.blue, 2);
  if (format == 8) put(bytes, 0xbbbb, 2);  // near infrared
  if (has_waveform) bytes.append(29, '\xcc');
  return bytes;
}

}  // namespace

std::string LasBytes::bytes() const {
  const bool is_14 = minor_version >= 4;
  const std::uint64_t header_size = is_14 ? 375 : minor_version == 3 ? 235 : 227;
  const std::string record_block = concatenated(records, 2);
  std::string point_block;
  for (const LasPoint& point : points) point_block += point_bytes(point, format) + std::string(num_extra_bytes, '\xdd');
  const std::size_t record_length = point_bytes({}, format).size() + num_extra_bytes;
  const std::uint64_t points_at = header_size + record_block.size();

  std::string file = "LASF";
  put(file, 0, 2);
  put(file, global_encoding, 2);
  put_padded(file, "", 16);
  put(file, 1, 1);
  put(file, minor_version, 1);
  put_padded(file, "system", 32);
  put_padded(file, "software", 32);
  put(file, 123, 2);
  put(file, 2024, 2);
  put(file, header_size, 2);
  put(file, points_at, 4);
  put(file, records.size(), 4);
  put(file, format, 1);
  put(file, record_length, 2);
  put(file, is_14 ? 0 : points.size(), 4);
  put_padded(file, "", 20);
  for (int axis = 0; axis < 3; ++axis) put(file, scale[axis]);
  for (int axis = 0; axis < 3; ++axis) put(file, offset[axis]);
  put_padded(file, "", 48);
  if (minor_version >= 3) put(file, 0, 8);
  if (is_14) {
    put(file, extended_records.empty() ? 0 : points_at + point_block.size(), 8);
    put(file, extended_records.size(), 4);
    put(file, points.size(), 8);
    put_padded(file, "", 120);
  }
  return file + record_block + point_block + concatenated(extended_records, 8);
}

std::string geo_keys(const std::vector<std::pair<std::uint16_t, std::uint16_t>>& keys) {
  std::string data;
  for (const std::uint64_t number :
       {std::uint64_t{1}, std::uint64_t{1}, std::uint64_t{0}, std::uint64_t{keys.size()}}) {
    put(data, number, 2);
  }
  for (const auto& [key, value] : keys) {
    put(data, key, 2);
    put(data, 0, 2);
    put(data, 1, 2);
    put(data, value, 2);
  }
  return data;
}

}  // namespace vdbmap::test
