// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "tools/simulator/route.h"

namespace vdbmap::simulator {

/// How a survey vehicle drives along a route.
struct DriveOptions {
  double from = 0;           ///< [m] along the route at the beginning
  double to = 100;           ///< [m] along the route at the end, at least
  double speed = 9;          ///< [m/s] on average
  double shortest_time = 0;  ///< [s] goes on driving for so long
  double start_time = 0;     ///< [s] of the clock at the beginning
  std::uint64_t seed = 1;
};

/// A drive with real accelerations: speed and lane vary, the body pitches with the brakes, rolls with the road, and
/// sways on its springs. Poses are known every millisecond and interpolated between.
class Drive {
 public:
  Drive(const Route& route, const DriveOptions& options);

  double start_time() const { return start_time_; }
  double end_time() const;

  /// The vehicle's frame: x forward, y left, z up, on the ground between its axles. Times outside the drive take its
  /// first or last pose.
  Eigen::Isometry3d scene_from_vehicle(double time) const;

 private:
  struct Pose {
    Eigen::Vector3d position;
    Eigen::Quaterniond rotation;
  };

  double start_time_;
  std::vector<Pose> poses_;
};

}  // namespace vdbmap::simulator
