// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/las/las_point_count.h"

#include <algorithm>
#include <string>

namespace vdbmap {
namespace {

// What else may follow the points says where it begins.
std::uint64_t count_held(const ByteReader& file, const LasHeader& header, const LasRecords& records) {
  std::uint64_t end = records.extended_begin.value_or(file.size());
  if (header.waveforms_offset >= header.points_offset) end = std::min(end, header.waveforms_offset);
  return (end - header.points_offset) / header.record_length;
}

bool is_known_number(std::uint64_t number) { return number != 0 && number != kUnknownLasCount; }

// Of the two numbers in a header of version 1.4 that of 64 bits, unless the other is just what the file holds.
std::uint64_t choose_number(const LasHeader& header, std::uint64_t num_held) {
  return is_known_number(header.num_points) && header.legacy_num_points != num_held ? header.num_points
                                                                                    : header.legacy_num_points;
}

bool says_two_numbers(const LasHeader& header) {
  return is_known_number(header.num_points) && is_known_number(header.legacy_num_points) &&
         header.num_points != header.legacy_num_points;
}

// What is wrong with a number that is known.
std::vector<ReadFinding> compare_with_held(std::uint64_t number, std::uint64_t num_held, const LasHeader& header) {
  std::vector<ReadFinding> findings;
  if (says_two_numbers(header)) {
    findings.push_back({"the header gives two numbers of points, " + std::to_string(header.num_points) + " and " +
                            std::to_string(header.legacy_num_points),
                        0, std::to_string(std::min(number, num_held)) + " are read", true});
  }
  const bool may_hold_more = header.num_extended_records > 0 || header.waveforms_offset > 0;
  if (number > num_held) {
    findings.push_back({"points are missing that the header counts", number - num_held,
                        "the file ends after point " + std::to_string(num_held), true});
  } else if (number < num_held && !may_hold_more) {
    findings.push_back({"points left out that the header does not count", num_held - number,
                        "point " + std::to_string(number + 1), true});
  }
  return findings;
}

}  // namespace

LasPointCount count_las_points(const ByteReader& file, const LasHeader& header, const LasRecords& records) {
  const std::uint64_t num_held = count_held(file, header, records);
  const std::uint64_t number = choose_number(header, num_held);
  if (is_known_number(number)) return {std::min(number, num_held), compare_with_held(number, num_held, header)};

  LasPointCount count{num_held, {}};
  if (num_held > 0) count.findings.push_back({"points read that the header does not count", num_held, "", true});
  return count;
}

}  // namespace vdbmap
