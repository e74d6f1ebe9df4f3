// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/file/text.h"
#include "vdbmap/io/pcd/lzf.h"
#include "vdbmap/io/pcd/pcd.h"
#include "vdbmap/io/pcd/pcd_header.h"
#include "vdbmap/io/points/point_cloud_filter.h"
#include "vdbmap/io/points/point_fields.h"
#include "vdbmap/io/table/word_points.h"

namespace vdbmap {
namespace {

using Fields = std::vector<std::optional<PointField>>;

[[noreturn]] void fail_without_coordinate(const ByteReader& reader, const PcdHeader& header, const std::string& name) {
  const auto field =
      std::ranges::find_if(header.fields, [&](const PcdField& known) { return lower_case(known.name) == name; });
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

std::uint64_t num_points_in(const PcdHeader& header, std::uint64_t most) { return std::min(header.num_points, most); }

// What stands behind the last point, and the points that do not come.
void note_rest(const ByteReader& reader, const PcdHeader& header, std::uint64_t num_points, std::uint64_t rest_begin,
               std::vector<ReadFinding>& findings) {
  if (num_points < header.num_points) {
    findings.push_back(missing_points(header.num_points, num_points));
    return;
  }
  const std::string_view rest = reader.all().substr(rest_begin);
  if (rest.find_first_not_of(std::string_view(" \t\r\n\0", 5)) == std::string_view::npos) return;
  findings.push_back({"bytes behind the last point passed over", rest.size()});
}

ReadResult read_text(ByteReader& reader, const PcdHeader& header, const Fields& fields) {
  // A number takes a digit and a separator, which the end of the file may replace.
  const std::uint64_t most = (reader.remaining() + 1) / (2 * header.numbers_per_point());
  if (most == 0) check_num_points(reader, header, most);
  std::vector<WordColumn> columns;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    columns.push_back({header.fields[i].name, fields[i], false, header.fields[i].count});
  }
  WordPoints words(std::move(columns), "field");
  words.read(reader, header.num_points);
  std::vector<ReadFinding> findings;
  note_rest(reader, header, words.num_points(), reader.offset(), findings);
  return words.finish(reader.path(), findings);
}

ReadResult read_binary(ByteReader& reader, const PcdHeader& header, const Fields& fields) {
  const std::uint64_t point_size = header.point_size();
  const std::uint64_t num_points = num_points_in(header, reader.remaining() / point_size);
  if (num_points == 0) check_num_points(reader, header, 0);
  const char* next = reader.bytes(num_points * point_size).data();
  std::vector<PointColumn> columns;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i]) columns.push_back({*fields[i], {next, point_size, type_to_load(*fields[i])}});
    next += header.fields[i].size();
  }
  PointCloud cloud = make_cloud(fields, num_points);
  store_columns(cloud, columns);
  std::vector<ReadFinding> findings;
  note_rest(reader, header, num_points, reader.offset(), findings);
  return finish_reading(reader.path(), std::move(cloud), {}, std::move(findings));
}

// Field after field, each with the numbers of all points.
PointCloud decode_uncompressed(std::string_view data, const PcdHeader& header, std::uint64_t num_points,
                               const Fields& fields) {
  const char* next = data.data();
  std::vector<PointColumn> columns;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i]) columns.push_back({*fields[i], {next, header.fields[i].size(), type_to_load(*fields[i])}});
    next += header.fields[i].size() * num_points;
  }
  PointCloud cloud = make_cloud(fields, num_points);
  store_columns(cloud, columns);
  return cloud;
}

// LZF expands up to 88 times, and a point of 3 bytes to 46 of a cloud. Real points don't: those of whole images, most
// of them NaN, are a few millions at most.
void check_expansion(const ByteReader& reader, std::uint64_t num_points, std::uint64_t point_size,
                     std::uint64_t compressed_size) {
  constexpr std::uint64_t kAlways = std::uint64_t{1} << 28;  // [bytes]
  constexpr std::uint64_t kPerByte = 32;
  constexpr std::uint64_t kMostOfPoint = 24 + 6 + 4 + 8 + 2 + 2;  // [bytes] of a cloud with every attribute
  const std::uint64_t size = num_points * std::max(point_size, kMostOfPoint);
  const std::uint64_t most = std::max(kAlways, kPerByte * compressed_size);
  if (size <= most) return;
  reader.fail(std::to_string(compressed_size) + " bytes would expand to " + std::to_string(num_points) + " points of " +
              std::to_string(size) + " bytes, allowed are " + std::to_string(most) +
              " bytes: write the file uncompressed");
}

ReadResult read_compressed(ByteReader& reader, const PcdHeader& header, const Fields& fields) {
  const auto compressed_size = reader.read_le<std::uint32_t>();
  const auto size = reader.read_le<std::uint32_t>();
  // The size tells where the numbers of each field begin, whatever the header promises.
  const std::uint64_t num_points = size / header.point_size();
  if (num_points == 0) check_num_points(reader, header, 0);
  if (size != num_points * header.point_size() || num_points > header.num_points) {
    reader.fail("the data expand to " + std::to_string(size) + " bytes, the header describes " +
                std::to_string(header.num_points) + " points of " + std::to_string(header.point_size()));
  }
  const std::uint64_t begin = reader.offset();
  const std::string_view compressed = reader.bytes(compressed_size);
  if (size / kMostLzfExpansion <= compressed_size)
    check_expansion(reader, num_points, header.point_size(), compressed_size);
  const std::optional<std::string> data = lzf_decompress(compressed, size);
  if (!data) {
    throw IoError::malformed_at_byte(reader.path(), begin, "not LZF data of " + std::to_string(size) + " bytes");
  }
  std::vector<ReadFinding> findings;
  note_rest(reader, header, num_points, reader.offset(), findings);
  return finish_reading(reader.path(), decode_uncompressed(*data, header, num_points, fields), {}, std::move(findings));
}

ReadResult read_data(ByteReader& reader, const PcdHeader& header, const Fields& fields) {
  if (header.encoding == PcdEncoding::kAscii) return read_text(reader, header, fields);
  if (header.encoding == PcdEncoding::kBinary) return read_binary(reader, header, fields);
  return read_compressed(reader, header, fields);
}

}  // namespace

ReadResult read_pcd(const std::filesystem::path& path) {
  ByteReader reader(path);
  const PcdHeader header = read_pcd_header(reader);
  const Fields fields = choose_fields(reader, header);
  ReadResult result = read_data(reader, header, fields);
  result.findings.insert(result.findings.begin(), header.findings.begin(), header.findings.end());
  return result;
}

}  // namespace vdbmap
