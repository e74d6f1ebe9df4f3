// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "registration/odometry/scan_clock.h"
#include "vdbmap/core/point_cloud.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::registration {

/// Measurements of a scan in the map: each ray goes from where the sensor was to a point.
struct ScanRays {
  PointCloud ends;                       ///< [m, system of the poses] deskewed where the motion is known
  std::vector<Eigen::Vector3d> origins;  ///< [m] one a point
  std::string time_problem = {};         ///< why it was not deskewed although it has time stamps; or empty
};

/// Turns the scans of a drive, one after the other, into rays. Poses are those of each scan's first point, as of
/// vdbmap localize; the motion during a scan is the constant twist from the pose before to the pose after it.
class ScanRayStream {
 public:
  /// `skipped` scans of the sequence were left out between two of these. Scans that are not to be deskewed are taken as
  /// measured from one place.
  explicit ScanRayStream(Trajectory poses, std::size_t skipped = 0, bool deskews = true);

  /// The rays of the next scan; nothing where it has no pose. Throws std::out_of_range behind the last pose.
  std::optional<ScanRays> next(PointCloud scan);

  /// Passes over a scan that could not be read.
  void pass_over() { ++number_, clock_.pass_over(1 + skipped_); }

 private:
  Trajectory poses_;
  std::size_t skipped_;
  bool deskews_;
  std::size_t number_ = 0;  // of the next scan
  ScanClock clock_;
};

}  // namespace vdbmap::registration
