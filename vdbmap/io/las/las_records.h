// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "vdbmap/io/las/las_header.h"

namespace vdbmap {

/// A variable length record.
struct LasRecord {
  std::string_view user;
  unsigned id = 0;
  std::string_view data;  ///< lives as long as the file's reader
};

/// The records of a file as far as they are whole: points do not need them.
struct LasRecords {
  std::vector<LasRecord> records;               ///< the extended ones last
  std::optional<std::uint64_t> extended_begin;  ///< [bytes] of the extended ones, where some stand there
  std::vector<ReadFinding> findings;
};

LasRecords read_las_records(ByteReader& file, const LasHeader& header);

}  // namespace vdbmap
