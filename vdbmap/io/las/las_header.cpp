// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/las/las_header.h"

#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/text.h"

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
constexpr std::uint64_t kWaveformsOffsetAt = 227;
constexpr std::uint64_t kExtendedOffsetAt = 235;
constexpr std::uint64_t kNumExtendedRecordsAt = 243;
constexpr std::uint64_t kNumPointsAt = 247;

constexpr std::uint64_t kHeaderSize14 = 375;  // [bytes]
constexpr std::uint16_t kWktBit = 1 << 4;
constexpr std::uint16_t kWaveformsInsideBit = 1 << 1;
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
  header.has_flags = header.minor_version >= 1;
  header.prefers_wkt = (read_at<std::uint16_t>(file, kGlobalEncodingAt) & kWktBit) != 0;
}

// Formats from 6 on came with version 1.4, whatever the file says.
bool is_of_14(const LasHeader& header) { return header.minor_version >= 4 || header.format.classification_at == 16; }

// Points need nothing of the header but where they begin: a size that cannot be costs the records behind it.
void check_size(ByteReader& file, LasHeader& header) {
  const std::uint64_t least = is_of_14(header) ? kHeaderSize14 : kLasHeaderSize;
  const std::uint64_t least_offset = header.size < least ? kLasHeaderSize : least;
  if (file.size() < least_offset) {
    fail_at(file, file.size(), "the file ends within its header of " + std::to_string(least_offset) + " bytes");
  }
  if (header.points_offset < least_offset || header.points_offset > file.size()) {
    fail_at(file, kPointsOffsetAt,
            "points begin at byte " + std::to_string(header.points_offset) + ", expected " +
                std::to_string(least_offset) + " to " + std::to_string(file.size()));
  }
  if (header.size >= least && header.size <= header.points_offset) return;
  add_finding(header.findings,
              {"the header cannot be of " + std::to_string(header.size) + " bytes, expected " + std::to_string(least) +
                   " to " + std::to_string(header.points_offset) + ": its variable length records are not read",
               0, "byte " + std::to_string(kHeaderSizeAt), true});
  header.num_records = 0;
}

// Whether the fields that version 1.4 added are there, although the size of the header may be wrong.
bool has_fields_of_14(const LasHeader& header) {
  const bool is_shorter = header.size >= kLasHeaderSize && header.size < kHeaderSize14;
  return is_of_14(header) && header.points_offset >= kHeaderSize14 && !(is_shorter && header.legacy_num_points != 0);
}

void read_sections(ByteReader& file, LasHeader& header) {
  header.size = read_at<std::uint16_t>(file, kHeaderSizeAt);
  header.points_offset = read_at<std::uint32_t>(file, kPointsOffsetAt);
  header.num_records = read_at<std::uint32_t>(file, kNumRecordsAt);
  const auto legacy = read_at<std::uint32_t>(file, kLegacyNumPointsAt);
  header.legacy_num_points = legacy == std::numeric_limits<std::uint32_t>::max() ? kUnknownLasCount : legacy;
  check_size(file, header);
  const bool has_waveforms = (read_at<std::uint16_t>(file, kGlobalEncodingAt) & kWaveformsInsideBit) != 0;
  if (header.minor_version >= 3 && has_waveforms && header.points_offset >= kWaveformsOffsetAt + 8) {
    const auto offset = read_at<std::uint64_t>(file, kWaveformsOffsetAt);
    header.waveforms_offset = offset <= file.size() ? offset : 0;
  }
  if (!has_fields_of_14(header)) return;
  header.extended_offset = read_at<std::uint64_t>(file, kExtendedOffsetAt);
  header.num_extended_records = read_at<std::uint32_t>(file, kNumExtendedRecordsAt);
  header.num_points = read_at<std::uint64_t>(file, kNumPointsAt);
}

void read_point_format(ByteReader& file, LasHeader& header) {
  const auto stored = read_at<std::uint8_t>(file, kFormatAt);
  if ((stored & kCompressionBits) == kCompressionBits) {
    fail_at(file, kFormatAt, "compressed by a program older than LASzip, which nothing reads any more");
  }
  const unsigned format = stored & ~kCompressionBits & 0xffU;
  header.is_compressed = (stored & kCompressionBits) != 0;
  header.format_number = format;
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

}  // namespace

std::optional<LasPointFormat> find_las_point_format(unsigned format) {
  static const std::array<LasPointFormat, 11> kFormats = {{
      {20, 15, 0x1f, 15, 0x80, {}, {}},
      {28, 15, 0x1f, 15, 0x80, 20, {}},
      {26, 15, 0x1f, 15, 0x80, {}, 20},
      {34, 15, 0x1f, 15, 0x80, 20, 28},
      {57, 15, 0x1f, 15, 0x80, 20, {}},
      {63, 15, 0x1f, 15, 0x80, 20, 28},
      {30, 16, 0xff, 15, 0x04, 22, {}},
      {36, 16, 0xff, 15, 0x04, 22, 30},
      {38, 16, 0xff, 15, 0x04, 22, 30},
      {59, 16, 0xff, 15, 0x04, 22, {}},
      {67, 16, 0xff, 15, 0x04, 22, 30},
  }};
  return format < kFormats.size() ? std::optional(kFormats[format]) : std::nullopt;
}

LasHeader read_las_header(ByteReader& file) {
  LasHeader header;
  read_version(file, header);
  read_point_format(file, header);
  read_sections(file, header);
  read_quantization(file, header);
  return header;
}

}  // namespace vdbmap
