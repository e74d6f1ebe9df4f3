// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/moving_scanner.h"

#include <numbers>

namespace vdbmap::test {

PointCloud scan_while_moving(const Scene& scene, const SensorPath& map_from_sensor_at, double start, double duration,
                             const Scanner& scanner) {
  PointCloud scan;
  for (int shot = 0; shot < scanner.num_azimuths; ++shot) {
    const double share = static_cast<double>(shot) / scanner.num_azimuths;
    const double time = start + share * duration;
    const Eigen::Isometry3d sensor_from_shot(Eigen::AngleAxisd(2 * std::numbers::pi * share, Eigen::Vector3d::UnitZ()));
    Scanner one_shot = scanner;
    one_shot.num_azimuths = 1;
    one_shot.seed = scanner.seed * 10'000 + static_cast<unsigned>(shot);
    for (const Eigen::Vector3d& point :
         scan_scene(scene, map_from_sensor_at(time) * sensor_from_shot, one_shot).positions) {
      scan.positions.emplace_back(sensor_from_shot * point);
      scan.times.push_back(time);
    }
  }
  return scan;
}

}  // namespace vdbmap::test
