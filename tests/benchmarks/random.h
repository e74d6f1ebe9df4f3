// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <random>

#include <Eigen/Core>

namespace vdbmap::benchmarks {

/// Random numbers that are the same with every standard library, whose own distributions are not.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [low, high).
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1.0p-53;
  }

  /// Near to normal: the sum of twelve uniform numbers (Irwin & Hall), at most six deviations off.
  double normal(double deviation) {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += uniform(0, 1);
    return deviation * sum;
  }

  /// Uniform on the unit sphere.
  Eigen::Vector3d direction() {
    for (;;) {
      const double z = uniform(-1, 1);
      const double y = uniform(-1, 1);
      const double x = uniform(-1, 1);
      const Eigen::Vector3d point(x, y, z);
      const double norm = point.norm();
      if (norm > 0.1 && norm <= 1) return point / norm;
    }
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace vdbmap::benchmarks
