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

/// How many points a file has room for.
struct LasHeldPoints {
  std::uint64_t least = 0;
  std::uint64_t most = 0;              ///< more than `least` where the end of the points does not say how many they are
  bool may_be_something_else = false;  ///< what follows the header's number of points need not be points
};

/// The number in the header where the file holds as many; what it holds at most where it ends too early; what it holds
/// for sure where the header gives no number, as writers leave it that did not come to their end.
LasPointCount choose_las_point_count(const LasHeader& header, const LasHeldPoints& held);

/// The same for points that are not compressed: those that are whole in the file.
LasPointCount count_las_points(const ByteReader& file, const LasHeader& header, const LasRecords& records);

}  // namespace vdbmap
