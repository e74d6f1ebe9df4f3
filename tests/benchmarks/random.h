// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "tools/simulator/random.h"

namespace vdbmap::benchmarks {

using simulator::Random;

/// Uniform on the unit sphere.
inline Eigen::Vector3d random_direction(Random& random) {
  for (;;) {
    const double z = random.uniform(-1, 1);
    const double y = random.uniform(-1, 1);
    const double x = random.uniform(-1, 1);
    const Eigen::Vector3d point(x, y, z);
    const double norm = point.norm();
    if (norm > 0.1 && norm <= 1) return point / norm;
  }
}

}  // namespace vdbmap::benchmarks
