// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Geometry>

namespace vdbmap::simulator {

/// What a mobile mapper does not know of itself: its trajectory drifts as GNSS and IMU do between houses, its scanners
/// are not quite where and as they are thought to be, cameras and lasers are set otherwise than on other days.
struct MapperError {
  /// amplitude * sin(2 pi * distance / length + phase) of the distance driven.
  struct Wave {
    double amplitude = 0;  ///< [m] or [rad]
    double length = 1;     ///< [m]
    double phase = 0;      ///< [rad]
  };

  std::array<std::array<Wave, 2>, 3> drift;  ///< [m] of the position, x y z of the scene
  std::array<Wave, 3> attitude;              ///< [rad] roll, pitch, yaw
  std::array<Eigen::Vector3d, 2> boresight = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};  ///< [rad] a scanner
  std::array<Eigen::Vector3d, 2> lever_arm = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};  ///< [m] a scanner
  std::array<double, 2> intensity_gain = {1, 1};                                                  ///< of a scanner
  Eigen::Array3d color_gain = Eigen::Array3d::Ones();  ///< red, green, blue: exposure and white balance
  bool has_camera_blunders = false;  ///< points that the camera does not see have the colour of what hides them

  /// The vehicle as the survey has it, when it is really at scene_from_vehicle, `distance` [m] after its start.
  Eigen::Isometry3d estimated(const Eigen::Isometry3d& scene_from_vehicle, double distance) const;

  /// Where a scanner is thought to be on the vehicle.
  Eigen::Isometry3d estimated_mounting(const Eigen::Isometry3d& vehicle_from_scanner, std::size_t scanner) const;
};

/// The errors of one survey: 2 to 5 cm of drift over 100 m, 0.1 to 0.3 mrad of boresight, 1 cm between its scanners.
MapperError make_mapper_error(std::uint64_t seed);

}  // namespace vdbmap::simulator
