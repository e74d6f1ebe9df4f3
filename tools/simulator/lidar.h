// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "tools/simulator/drive.h"
#include "tools/simulator/pulse.h"
#include "tools/simulator/survey.h"

namespace vdbmap::simulator {

/// One laser of a turning scanner.
struct Laser {
  double elevation;            ///< [rad] as the scanner believes
  double delay;                ///< [s] after the first laser of the firing
  std::uint16_t ring;          ///< counted from the lowest
  double range_bias = 0;       ///< [m] that calibration left over
  double elevation_error = 0;  ///< [rad] really higher than the scanner believes
};

/// A scanner that turns about its vertical, clockwise seen from above, from x on. Frame: x forward, y left, z up.
struct LidarModel {
  std::vector<Laser> lasers;  ///< in the order of firing
  int num_firings;            ///< in a turn
  double turn_time;           ///< [s]
  PulseModel pulse;
  Eigen::Isometry3d vehicle_from_scanner;
  double clock_error = 0;  ///< [s] that time stamps are late
  double blooming = 0;     ///< chance that a pulse beside a retroreflector measures that instead of what is behind

  /// Angle [rad], clockwise from x, `time` [s] after the turn began.
  double azimuth(double time) const;

  /// Where the laser looks [scanner frame] when it fires `time` [s] after the turn began.
  Eigen::Vector3d direction(const Laser& laser, double time) const;

  /// When a laser fires [s after the turn began].
  double firing_time(int firing, const Laser& laser) const;
};

/// One scanner of a model, with what its calibration left: biases of ranges to 2 cm and of elevations to 0.1 degrees
/// a beam, time stamps off by up to a millisecond, and blooming.
LidarModel with_errors(LidarModel lidar, std::uint64_t seed);

/// Velodyne VLP-16: 16 lasers from -15 to +15 degrees, 1800 firings a turn, 10 Hz, 3 cm of noise, 100 m.
LidarModel vlp16();

/// Velodyne HDL-64E: 32 lasers from +2 to -8.33 degrees a third of a degree apart, 32 down to -24.33 degrees half a
/// degree apart; 10 Hz, 80 m as in KITTI's drives. Its 2 cm are mostly what calibration left of each laser's bias.
LidarModel hdl64();

/// Velodyne HDL-32E: 32 lasers from +10.67 to -30.67 degrees, 10 Hz, 2 cm of noise, 100 m.
LidarModel hdl32();

/// Ouster OS1-128: 128 lasers from +22.5 to -22.5 degrees that fire at once, 1024 times a turn, 10 Hz, 120 m.
LidarModel os1_128();

/// One turn that begins at `start_time` [s] while the vehicle drives: points in the scanner's frame at the time of
/// each, in the order of firing, with intensities (0..100 diffuse, to 255 retroreflectors), rings and times as the
/// scanner's clock has them.
Survey scan_turn(const SceneView& view, const Drive& drive, const LidarModel& lidar, double start_time,
                 std::uint64_t seed);

}  // namespace vdbmap::simulator
