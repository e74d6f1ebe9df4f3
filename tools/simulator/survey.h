// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "vdbmap/core/point_cloud.h"

namespace vdbmap::simulator {

/// What a point was measured on: the numbers of SurfaceClass and of the world's object.
struct PointTruth {
  std::uint16_t label;
  std::uint16_t object;

  bool operator==(const PointTruth&) const = default;
};

/// Points and the truth of each.
struct Survey {
  PointCloud cloud;
  std::vector<PointTruth> truth;

  void append(const Survey& other);
};

}  // namespace vdbmap::simulator
