// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

#include "tools/simulator/camera.h"
#include "tools/simulator/drive.h"
#include "tools/simulator/pulse.h"
#include "tools/simulator/survey.h"

namespace vdbmap::simulator {

/// A mobile mapper like the Riegl VMX-250: two line scanners on the roof whose planes cross, so that what faces along
/// the street is seen too.
struct MapperModel {
  int pulses_per_line = 3000;  ///< 300 kHz a scanner
  double line_rate = 100;      ///< [1/s]
  PulseModel pulse;
  std::array<Eigen::Isometry3d, 2> vehicle_from_scanner;  ///< beams lie in the scanners' y-z planes

  /// Where the pulse looks [scanner frame].
  Eigen::Vector3d direction(int pulse_of_line) const;
};

MapperModel vmx250();

/// Everything that the mapper measures on a drive: points in EPSG:25832 (`origin` is the scene's), in the order of the
/// lines, with colours, intensities (reflectances) and times.
Survey map_street(const SceneView& view, const Drive& drive, const MapperModel& mapper, const Daylight& light,
                  const Eigen::Vector3d& origin, std::uint64_t seed);

}  // namespace vdbmap::simulator
