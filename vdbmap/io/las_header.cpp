// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/las_header.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "vdbmap/core/error.h"
#include "vdbmap/io/text.h"

namespace vdbmap {
namespace {

// LAS Specification 1.4-R15, table 3: where the public header block holds what.
constexpr std::uint64_t kGlobalEncodingAt = 6;
constexpr std::uint64_t kVersionAt = 24;
constexpr std::uint64_t kHeaderSizeAt = 94;
constexpr std::uint64_t kPointsOffsetAt = 96;
constexpr std::uint64_t kNumRecordsAt = 100;
constexpr std::uint64_t kFormatAt = 104;
constexpr std::uint64_t kRecordLengthAt = 105;
constexpr std::uint64_t kLegacyNumPointsAt = 107;
constexpr std::uint64_t kScaleAt = 131;
constexpr std::uint64_t kOffsetAt = 155;
constexpr std::uint64_t kExtendedOffsetAt = 235;
constexpr std::uint64_t kNumExtendedRecordsAt = 243;
constexpr std::uint64_t kNumPointsAt = 247;

constexpr std::uint64_t kHeaderSize14 = 375;  // [bytes]
constexpr std::uint16_t kWktBit = 1 << 4;
constexpr std::uint8_t kCompressionBits = 0xc0;

template <Scalar T>
T read_at(ByteReader& file, std::uint64_t at) {
  file.seek(at);
  return file.read_le<T>();
}

[[noreturn]] void fail_at(const ByteReader& file, std::uint64_t at, const std::string& reason) {
  throw IoError::malformed_at_byte(file.path(), at, reason);
}

void read_version(ByteReader& file, LasHeader& header) {
  file.seek(0);
  const std::string_view signature = file.bytes(4);
  if (signature != "LASF") fail_at(file, 0, "not a LAS file: begins with " + quoted(signature) + ", expected 'LASF'");

  const unsigned major = read_at<std::uint8_t>(file, kVersionAt);
  header.minor_version = file.read_le<std::uint8_t>();
  if (major != 1 || header.minor_version > 4) {
    fail_at(
        file, kVersionAt,
        "LAS version " + std::to_string(major) + "." + std::to_string(header.minor_version) + ", expected 1.0 to 1.4");
  }
  header.prefers_wkt = (read_at<std::uint16_t>(file, kGlobalEncodingAt) & kWktBit) != 0;
}

void read_sections(ByteReader& file, LasHeader& header) {
  header.size = read_at<std::uint16_t>(file, kHeaderSizeAt);
  const std::uint64_t least_size = header.minor_version >= 4 ? kHeaderSize14 : kLasHeaderSize;
  if (header.size < least_size) {
    fail_at(file, kHeaderSizeAt,
            "header of " + std::to_string(header.size) + " bytes, expected at least " + std::to_string(least_size) +
                " in LAS 1." + std::to_string(header.minor_version));
  }
  header.points_offset = read_at<std::uint32_t>(file, kPointsOffsetAt);
  if (header.points_offset < header.size || header.points_offset > file.size()) {
    fail_at(file, kPointsOffsetAt,
            "points begin at byte " + std::to_string(header.points_offset) + ", expected " +
                std::to_string(header.size) + " to " + std::to_string(file.size()));
  }
  header.num_records = read_at<std::uint32_t>(file, kNumRecordsAt);
  if (header.minor_version >= 4) {
    header.extended_offset = read_at<std::uint64_t>(file, kExtendedOffsetAt);
    header.num_extended_records = read_at<std::uint32_t>(file, kNumExtendedRecordsAt);
  }
}

void read_point_format(ByteReader& file, LasHeader& header) {
  const auto format = read_at<std::uint8_t>(file, kFormatAt);
  if ((format & kCompressionBits) != 0) {
    fail_at(file, kFormatAt, "LAZ compression is not supported: decompress the file first (laszip, pdal translate)");
  }
  const auto layout = find_las_point_format(format);
  if (!layout) fail_at(file, kFormatAt, "point format " + std::to_string(format) + ", expected 0 to 10");
  header.format = *layout;

  header.record_length = read_at<std::uint16_t>(file, kRecordLengthAt);
  if (header.record_length < header.format.length) {
    fail_at(file, kRecordLengthAt,
            "points of " + std::to_string(header.record_length) + " bytes, expected at least " +
                std::to_string(header.format.length) + " in format " + std::to_string(format));
  }
}

void read_num_points(ByteReader& file, LasHeader& header) {
  std::uint64_t at = kLegacyNumPointsAt;
  header.num_points = read_at<std::uint32_t>(file, at);
  if (header.minor_version >= 4) {
    const auto num_points = read_at<std::uint64_t>(file, kNumPointsAt);
    if (num_points != 0) {
      header.num_points = num_points;
      at = kNumPointsAt;
    }
  }
  const std::uint64_t num_held = (file.size() - header.points_offset) / header.record_length;
  if (header.num_points > num_held) {
    fail_at(file, at,
            "the header promises " + std::to_string(header.num_points) + " points of " +
                std::to_string(header.record_length) + " bytes, the file holds " + std::to_string(num_held));
  }
}

void read_quantization(ByteReader& file, LasHeader& header) {
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint64_t scale_at = kScaleAt + 8 * static_cast<std::uint64_t>(axis);
    const std::uint64_t offset_at = kOffsetAt + 8 * static_cast<std::uint64_t>(axis);
    header.scale[axis] = read_at<double>(file, scale_at);
    header.offset[axis] = read_at<double>(file, offset_at);
    if (!std::isfinite(header.scale[axis]) || header.scale[axis] == 0) {
      fail_at(file, scale_at,
              "scale " + std::to_string(header.scale[axis]) + ", expected a finite number other than 0");
    }
    if (!std::isfinite(header.offset[axis])) fail_at(file, offset_at, "offset is not a finite number");
  }
}

LasRecord read_record(ByteReader& file, bool is_extended) {
  LasRecord record;
  file.skip(2);
  record.user = file.bytes(16);
  record.user = record.user.substr(0, record.user.find('\0'));
  record.id = file.read_le<std::uint16_t>();
  const std::uint64_t length = is_extended ? file.read_le<std::uint64_t>() : file.read_le<std::uint16_t>();
  file.skip(32);
  record.data = file.bytes(length);
  return record;
}

}  // namespace

std::optional<LasPointFormat> find_las_point_format(unsigned format) {
  static const std::array<LasPointFormat, 11> kFormats = {{
      {20, 15, 0x1f, {}, {}},
      {28, 15, 0x1f, 20, {}},
      {26, 15, 0x1f, {}, 20},
      {34, 15, 0x1f, 20, 28},
      {57, 15, 0x1f, 20, {}},
      {63, 15, 0x1f, 20, 28},
      {30, 16, 0xff, 22, {}},
      {36, 16, 0xff, 22, 30},
      {38, 16, 0xff, 22, 30},
      {59, 16, 0xff, 22, {}},
      {67, 16, 0xff, 22, 30},
  }};
  return format < kFormats.size() ? std::optional(kFormats[format]) : std::nullopt;
}

LasHeader read_las_header(ByteReader& file) {
  LasHeader header;
  read_version(file, header);
  read_point_format(file, header);
  read_sections(file, header);
  read_quantization(file, header);
  read_num_points(file, header);
  return header;
}

std::vector<LasRecord> read_las_records(ByteReader& file, const LasHeader& header) {
  std::vector<LasRecord> records;
  file.seek(header.size);
  for (std::uint64_t i = 0; i < header.num_records; ++i) {
    const std::uint64_t begin = file.offset();
    records.push_back(read_record(file, false));
    if (file.offset() > header.points_offset) {
      fail_at(file, begin,
              "variable length record " + std::to_string(i) + " runs into the points, which begin at byte " +
                  std::to_string(header.points_offset));
    }
  }
  if (header.num_extended_records == 0) return records;

  file.seek(header.extended_offset);
  for (std::uint64_t i = 0; i < header.num_extended_records; ++i) records.push_back(read_record(file, true));
  return records;
}

}  // namespace vdbmap
