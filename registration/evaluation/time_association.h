// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::registration {

/// How far apart the times of a scan in two files may be [s]; evo's default too.
inline constexpr double kMaxTimeDifference = 0.01;

struct TimeAssociation {
  Trajectory estimate;             ///< one entry a true pose that is judged; nothing where no estimate is near
  Trajectory truth;                ///< the true poses that are judged, with their times
  std::size_t num_unmatched = 0;   ///< estimated poses near no true one
  std::size_t num_not_judged = 0;  ///< true poses of times at which no scan is thought to have been taken
};

/// Lays estimated poses beside the true ones by their times: a pair is each other's nearest and at most
/// `max_difference` [s] apart. Times need not ascend.
///
/// A true pose without an estimate is a missing estimate. Only where the truth has more than one and a half poses to
/// each interval of the estimates (motion capture at 100 Hz, scans at 10 Hz), it has poses that belong to no scan: then
/// an estimate is missing where the estimates have a hole of more than one and a half of their own intervals, once for
/// every interval in it, and not before the first or after the last of them. Throws std::invalid_argument where a
/// trajectory has no times or the difference is not 0 or above.
TimeAssociation associate_by_time(const Trajectory& estimate, const Trajectory& truth,
                                  double max_difference = kMaxTimeDifference);

}  // namespace vdbmap::registration
