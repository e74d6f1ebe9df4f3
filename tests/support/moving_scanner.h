// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include <Eigen/Geometry>

#include "tests/support/synthetic_scene.h"

namespace vdbmap::test {

/// Where the scanner is at a time [s].
using SensorPath = std::function<Eigen::Isometry3d(double seconds)>;

/// What a scanner sees that moves while it turns once, from `start` [s] on for `duration` [s]: points [m] in its frame
/// at the time of each, with these times.
PointCloud scan_while_moving(const Scene& scene, const SensorPath& map_from_sensor_at, double start, double duration,
                             const Scanner& scanner = {});

}  // namespace vdbmap::test
