// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "tools/simulator/scene_view.h"
#include "vdbmap/core/point_cloud.h"

namespace vdbmap::simulator {

/// Points and the truth of each.
struct Survey {
  PointCloud cloud;
  std::vector<PointTruth> truth;

  void append(const Survey& other);
};

}  // namespace vdbmap::simulator
