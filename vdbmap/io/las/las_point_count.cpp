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

// Of the two numbers in a header of version 1.4 that of 64 bits, unless only the other can be true.
std::uint64_t choose_number(const LasHeader& header, const LasHeldPoints& held) {
  const auto can_be_true = [&](std::uint64_t number) {
    return is_known_number(number) && number >= held.least && number <= held.most;
  };
  const bool prefers_other = can_be_true(header.legacy_num_points) && !can_be_true(header.num_points);
  return is_known_number(header.num_points) && !prefers_other ? header.num_points : header.legacy_num_points;
}

bool says_two_numbers(const LasHeader& header) {
  return is_known_number(header.num_points) && is_known_number(header.legacy_num_points) &&
         header.num_points != header.legacy_num_points;
}

// What is wrong with a number that is known.
std::vector<ReadFinding> compare_with_held(std::uint64_t number, const LasHeldPoints& held, const LasHeader& header) {
  std::vector<ReadFinding> findings;
  if (says_two_numbers(header)) {
    findings.push_back({"the header gives two numbers of points, " + std::to_string(header.num_points) + " and " +
                            std::to_string(header.legacy_num_points),
                        0, std::to_string(std::min(number, held.most)) + " are read", true});
  }
  if (number > held.most) {
    findings.push_back({"points are missing that the header counts", number - held.most,
                        "the file ends after point " + std::to_string(held.most), true});
  } else if (number < held.least && !held.may_be_something_else) {
    findings.push_back({"points left out that the header does not count", held.least - number,
                        "point " + std::to_string(number + 1), true});
  }
  return findings;
}

}  // namespace

LasPointCount choose_las_point_count(const LasHeader& header, const LasHeldPoints& held) {
  const std::uint64_t number = choose_number(header, held);
  if (is_known_number(number)) return {std::min(number, held.most), compare_with_held(number, held, header)};

  LasPointCount count{held.least, {}};
  if (held.least < held.most) {
    --count.num_points;  // those before the last chunk
    count.findings.push_back(
        {"points of the last chunk left out: the header does not say how many they are", 0, "", true});
  }
  if (count.num_points > 0) {
    count.findings.push_back({"points read that the header does not count", count.num_points, "", true});
  }
  return count;
}

LasPointCount count_las_points(const ByteReader& file, const LasHeader& header, const LasRecords& records) {
  const std::uint64_t num_held = count_held(file, header, records);
  const bool may_hold_more = header.num_extended_records > 0 || header.waveforms_offset > 0;
  return choose_las_point_count(header, {num_held, num_held, may_hold_more});
}

}  // namespace vdbmap
