// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "vdbmap/core/point_cloud.h"

namespace vdbmap {

/// What every point file needs before it is written: throws std::invalid_argument unless the cloud has points, all
/// coordinates are finite, and every attribute is empty or as long as the positions.
void check_writable_cloud(const PointCloud& cloud);

}  // namespace vdbmap
