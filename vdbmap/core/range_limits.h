// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace vdbmap {

/// Distances from the sensor [m] between which points are used.
struct RangeLimits {
  double min = 1.0;
  double max = 100.0;
};

}  // namespace vdbmap
