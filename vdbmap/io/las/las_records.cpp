// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/las/las_records.h"

#include <algorithm>
#include <string>

namespace vdbmap {
namespace {

constexpr std::uint64_t kUserAt = 2;
constexpr std::uint64_t kUserSize = 16;
constexpr std::uint64_t kShortHeaderSize = 54;  // [bytes]
constexpr std::uint64_t kLongHeaderSize = 60;   // [bytes]

struct RecordSection {
  std::uint64_t begin = 0;  // [bytes] from the front of the file
  std::uint64_t end = 0;
  std::uint64_t num_records = 0;
  bool is_extended = false;

  std::uint64_t header_size() const { return is_extended ? kLongHeaderSize : kShortHeaderSize; }
};

// The record at `at`, nothing where it does not end in its section. Moves the file to the record's end.
std::optional<LasRecord> find_record(ByteReader& file, std::uint64_t at, const RecordSection& section) {
  if (at > section.end || section.end - at < section.header_size()) return std::nullopt;
  LasRecord record;
  file.seek(at + kUserAt);
  record.user = file.bytes(kUserSize);
  record.user = record.user.substr(0, record.user.find('\0'));
  record.id = file.read_le<std::uint16_t>();
  const std::uint64_t length = section.is_extended ? file.read_le<std::uint64_t>() : file.read_le<std::uint16_t>();
  file.skip(32);
  if (length > section.end - file.offset()) return std::nullopt;
  record.data = file.bytes(length);
  return record;
}

// Whether a record begins there, whole or not: it names its user in letters, which points hardly do.
bool may_be_record(ByteReader& file, std::uint64_t at) {
  file.seek(at);
  if (file.remaining() < kLongHeaderSize) return false;
  file.skip(kUserAt);
  const std::string_view field = file.bytes(kUserSize);
  const std::string_view user = field.substr(0, field.find('\0'));
  const auto is_printable = [](char c) { return c >= ' ' && c <= '~'; };
  return !user.empty() && std::ranges::all_of(user, is_printable) &&
         field.find_first_not_of('\0', user.size()) == std::string_view::npos;
}

ReadFinding lost_records(std::uint64_t count, const RecordSection& section, std::uint64_t at) {
  return {section.is_extended ? "extended variable length records that are damaged or missing left out"
                              : "variable length records that are damaged or missing left out",
          count, "byte " + std::to_string(at), true};
}

// Where a record is damaged nobody knows where the next one begins.
void append_records(ByteReader& file, const RecordSection& section, LasRecords& result) {
  std::uint64_t at = section.begin;
  for (std::uint64_t i = 0; i < section.num_records; ++i) {
    const std::optional<LasRecord> record = find_record(file, at, section);
    if (!record) return add_finding(result.findings, lost_records(section.num_records - i, section, at));
    result.records.push_back(*record);
    at = file.offset();
  }
}

}  // namespace

LasRecords read_las_records(ByteReader& file, const LasHeader& header) {
  LasRecords result;
  append_records(file, {header.size, header.points_offset, header.num_records, false}, result);
  if (header.num_extended_records == 0) return result;

  const RecordSection extended{header.extended_offset, file.size(), header.num_extended_records, true};
  if (extended.begin < header.points_offset || extended.begin > file.size() || !may_be_record(file, extended.begin)) {
    add_finding(result.findings, lost_records(extended.num_records, extended, extended.begin));
    return result;
  }
  result.extended_begin = extended.begin;
  append_records(file, extended, result);
  return result;
}

}  // namespace vdbmap
