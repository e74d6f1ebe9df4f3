// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

#include "tools/simulator/camera.h"
#include "tools/simulator/drive.h"
#include "tools/simulator/mapper_error.h"
#include "tools/simulator/pulse.h"
#include "tools/simulator/survey.h"
#include "tools/simulator/survey_frame.h"

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

/// What else a survey is made of; no errors, and nobody keeps a frame, where nothing is given.
struct MapOptions {
  const MapperError* error = nullptr;
  SurveyFrame* frame = nullptr;  ///< takes note of every eighth point
  double speed = 13;             ///< [m/s] that turns times into distances for the error
};

/// Everything that the mapper measures on a drive: points in EPSG:25832 (`origin` is the scene's), in the order of the
/// lines, with colours, intensities (reflectances) and times.
Survey map_street(const SceneView& view, const Drive& drive, const MapperModel& mapper, const Daylight& light,
                  const Eigen::Vector3d& origin, std::uint64_t seed, const MapOptions& options = {});

/// The same in parts: the lines from one time to another [s]; parts that follow each other make the whole.
Survey map_part(const SceneView& view, const Drive& drive, const MapperModel& mapper, const Daylight& light,
                const Eigen::Vector3d& origin, std::uint64_t seed, const MapOptions& options, double from, double to);

}  // namespace vdbmap::simulator
