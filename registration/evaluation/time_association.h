// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "vdbmap/io/trajectory_file.h"

namespace vdbmap::registration {

/// How far apart the times of a scan in two files may be [s]; evo's default too.
inline constexpr double kMaxTimeDifference = 0.01;

struct TimeAssociation {
  Trajectory estimate;            ///< one entry a true pose, with its time; nothing where no estimate is near
  std::size_t num_unmatched = 0;  ///< estimated poses near no true one
};

/// Lays estimated poses beside the true ones by their times: a pair is each other's nearest and at most
/// `max_difference` [s] apart. Times need not ascend. Throws std::invalid_argument where a trajectory has no times or
/// the difference is not 0 or above.
TimeAssociation associate_by_time(const Trajectory& estimate, const Trajectory& truth,
                                  double max_difference = kMaxTimeDifference);

}  // namespace vdbmap::registration
