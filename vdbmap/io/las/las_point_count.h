// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "vdbmap/io/las/las_records.h"

namespace vdbmap {

/// How many points are to be read, whatever the header says.
struct LasPointCount {
  std::uint64_t num_points = 0;  ///< all of them whole in the file
  std::vector<ReadFinding> findings;
};

/// The number in the header where the file holds as many; what it holds where it ends too early or where the header
/// gives no number, as writers leave it that did not come to their end.
LasPointCount count_las_points(const ByteReader& file, const LasHeader& header, const LasRecords& records);

}  // namespace vdbmap
