// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/io/byte_reader.h"
#include "vdbmap/io/lzf.h"
#include "vdbmap/io/pcd.h"
#include "vdbmap/io/pcd_header.h"
#include "vdbmap/io/point_cloud_filter.h"
#include "vdbmap/io/point_fields.h"
#include "vdbmap/io/text.h"

namespace vdbmap {
namespace {

using Fields = std::vector<std::optional<PointField>>;

[[noreturn]] void fail_without_coordinate(const ByteReader& reader, const PcdHeader& header, const std::string& name) {
  const auto field = std::ranges::find(header.fields, name, &PcdField::name);
  const std::string reason = field == header.fields.end() ? "the points have no field '" + name + "'"
                                                          : "field '" + name + "' holds " +
                                                                std::to_string(field->count) + " numbers, expected 1";
  throw IoError::malformed_at_line(reader.path(), header.fields_line, reason);
}

// The place of each field in a PointCloud; several numbers have none.
Fields choose_fields(const ByteReader& reader, const PcdHeader& header) {
  std::vector<NamedField> numbers;
  for (const PcdField& field : header.fields) numbers.push_back({field.count == 1 ? field.name : "", field.type});
  Fields fields = choose_point_fields(numbers);
  if (const auto missing = missing_coordinate(fields)) fail_without_coordinate(reader, header, *missing);
  return fields;
}

// A header's word on the number of points is worth what the rest of the file can hold.
void check_num_points(const ByteReader& reader, const PcdHeader& header, std::uint64_t most) {
  if (header.num_points <= most) return;
  throw IoError::malformed_at_line(reader.path(), header.num_points_line,
                                   "the header promises " + std::to_string(header.num_points) +
                                       " points, the file holds at most " + std::to_string(most));
}

std::string_view read_word(const ByteReader& reader, std::string_view& rest, const PcdField& field) {
  const std::string_view word = next_word(rest);
  if (word.empty()) reader.fail_line("the line ends before field " + vdbmap::quoted(field.name));
  return word;
}

void read_text_point(ByteReader& reader, const PcdHeader& header, const Fields& fields, std::size_t point,
                     PointCloud& cloud) {
  std::string_view rest = read_filled_line(reader);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const PcdField& field = header.fields[i];
    for (std::uint64_t skipped = fields[i] ? 0 : field.count; skipped > 0; --skipped) read_word(reader, rest, field);
    if (!fields[i]) continue;

    const std::string_view word = read_word(reader, rest, field);
    const std::optional<double> number = parse_number(word);
    if (!number)
      reader.fail_line("field " + vdbmap::quoted(field.name) + " is " + quoted(word) + ", expected a number");
    const double stored = number_from_text(*fields[i], *number);
    store_numbers(cloud, *fields[i], point, {&stored, 1});
  }
  if (const auto surplus = next_word(rest); !surplus.empty()) {
    reader.fail_line("found " + quoted(surplus) + " after the last field");
  }
}

PointCloud read_text(ByteReader& reader, const PcdHeader& header, const Fields& fields) {
  // A number takes a digit and a separator, which the end of the file may replace.
  check_num_points(reader, header, (reader.remaining() + 1) / (2 * header.numbers_per_point()));
  PointCloud cloud = make_cloud(fields, header.num_points);
  for (std::size_t point = 0; point < header.num_points; ++point) {
    read_text_point(reader, header, fields, point, cloud);
  }
  return cloud;
}

PointCloud read_binary(ByteReader& reader, const PcdHeader& header, const Fields& fields) {
  const std::uint64_t point_size = header.point_size();
  check_num_points(reader, header, reader.remaining() / point_size);
  const char* next = reader.bytes(header.num_points * point_size).data();
  std::vector<PointColumn> columns;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i]) columns.push_back({*fields[i], {next, point_size, type_to_load(*fields[i])}});
    next += header.fields[i].size();
  }
  PointCloud cloud = make_cloud(fields, header.num_points);
  store_columns(cloud, columns);
  return cloud;
}

// Field after field, each with the numbers of all points.
PointCloud decode_uncompressed(std::string_view data, const PcdHeader& header, const Fields& fields) {
  const char* next = data.data();
  std::vector<PointColumn> columns;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i]) columns.push_back({*fields[i], {next, header.fields[i].size(), type_to_load(*fields[i])}});
    next += header.fields[i].size() * header.num_points;
  }
  PointCloud cloud = make_cloud(fields, header.num_points);
  store_columns(cloud, columns);
  return cloud;
}

// LZF expands up to 88 times, and a point of 3 bytes to 46 of a cloud. Real points don't: those of whole images, most
// of them NaN, are a few millions at most.
void check_expansion(const ByteReader& reader, const PcdHeader& header, std::uint64_t compressed_size) {
  constexpr std::uint64_t kAlways = std::uint64_t{1} << 28;  // [bytes]
  constexpr std::uint64_t kPerByte = 32;
  constexpr std::uint64_t kMostOfPoint = 24 + 6 + 4 + 8 + 2 + 2;  // [bytes] of a cloud with every attribute
  const std::uint64_t size = header.num_points * std::max(header.point_size(), kMostOfPoint);
  const std::uint64_t most = std::max(kAlways, kPerByte * compressed_size);
  if (size <= most) return;
  reader.fail(std::to_string(compressed_size) + " bytes would expand to " + std::to_string(header.num_points) +
              " points of " + std::to_string(size) + " bytes, allowed are " + std::to_string(most) +
              " bytes: write the file uncompressed");
}

PointCloud read_compressed(ByteReader& reader, const PcdHeader& header, const Fields& fields) {
  const auto compressed_size = reader.read_le<std::uint32_t>();
  const auto size = reader.read_le<std::uint32_t>();
  check_num_points(reader, header, size / header.point_size());
  if (size != header.num_points * header.point_size()) {
    reader.fail("the data expand to " + std::to_string(size) + " bytes, the header describes " +
                std::to_string(header.num_points * header.point_size()));
  }
  const std::uint64_t begin = reader.offset();
  const std::string_view compressed = reader.bytes(compressed_size);
  if (size / kMostLzfExpansion <= compressed_size) check_expansion(reader, header, compressed_size);
  const std::optional<std::string> data = lzf_decompress(compressed, size);
  if (!data) {
    throw IoError::malformed_at_byte(reader.path(), begin, "not LZF data of " + std::to_string(size) + " bytes");
  }
  return decode_uncompressed(*data, header, fields);
}

PointCloud read_data(ByteReader& reader, const PcdHeader& header, const Fields& fields) {
  if (header.encoding == PcdEncoding::kAscii) return read_text(reader, header, fields);
  if (header.encoding == PcdEncoding::kBinary) return read_binary(reader, header, fields);
  return read_compressed(reader, header, fields);
}

}  // namespace

ReadResult read_pcd(const std::filesystem::path& path) {
  ByteReader reader(path);
  const PcdHeader header = read_pcd_header(reader);
  const Fields fields = choose_fields(reader, header);
  return finish_reading(path, read_data(reader, header, fields));
}

}  // namespace vdbmap
