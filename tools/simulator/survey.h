// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "vdbmap/core/point_cloud.h"
#include "vdbmap/io/kitti/label_file.h"

namespace vdbmap::simulator {

/// What a point was measured on: the numbers of SurfaceClass and of the world's object.
using PointTruth = PointLabel;

/// Points and the truth of each.
struct Survey {
  PointCloud cloud;
  std::vector<PointTruth> truth;

  void append(const Survey& other);
};

}  // namespace vdbmap::simulator
