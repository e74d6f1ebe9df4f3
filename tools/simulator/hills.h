// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>

#include <Eigen/Core>

#include "tools/simulator/random.h"

namespace vdbmap::simulator {

/// Rolling ground under several streets: three waves.
struct Hills {
  struct Wave {
    double amplitude;        ///< [m]
    Eigen::Vector2d number;  ///< [rad/m]
    double phase;            ///< [rad]
  };
  std::array<Wave, 3> waves;

  /// Height [m] at a place of the scene.
  double height(const Eigen::Vector2d& point) const {
    double sum = 0;
    for (const Wave& wave : waves) sum += wave.amplitude * std::sin(wave.number.dot(point) + wave.phase);
    return sum;
  }
};

/// Hills no steeper than some 4 %.
inline Hills make_hills(Random& random) {
  Hills hills{};
  for (Hills::Wave& wave : hills.waves) {
    const double length = random.uniform(120, 320), bearing = random.uniform(0, 2 * std::numbers::pi);
    const double number = 2 * std::numbers::pi / length;
    wave = {random.uniform(0.006, 0.014) / number, number * Eigen::Vector2d(std::cos(bearing), std::sin(bearing)),
            random.uniform(0, 2 * std::numbers::pi)};
  }
  return hills;
}

}  // namespace vdbmap::simulator
