// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "registration/rigid_motion.h"
#include "vdbmap/core/point_cloud.h"

namespace vdbmap::registration {

/// How the sensor moved while it took a scan: with a constant twist, zero where that is not known.
struct ScanMotion {
  double reference_time = 0;          ///< [s] when the sensor stood in the frame of the scan: at its first point
  Vector6d twist = Vector6d::Zero();  ///< angular velocity [rad/s], then velocity [m/s]; axes of the sensor
  double lead = 0;                    ///< [s] from the reference time to the mean time of the points, the middle
  double elapsed = 0;                 ///< [s] from the begin of the sequence to the reference time, by any clock

  /// Where the sensor stood in the middle. A scan that is deskewed with a wrong twist and then aligned lies right in
  /// the middle and wrong at its first point.
  Eigen::Isometry3d first_from_middle() const { return motion_of_twist(lead * twist); }
};

/// Mean of times [s] after the first; 0 where there are none.
double mean_lead(std::span<const double> times, double first);

/// The points as if all had been measured at the reference time (Vizzo 2023, section III-A, with the twist constant in
/// the frame of the moving sensor): positions [m] in the frame of the sensor at their times [s], one a point. Throws
/// std::invalid_argument where the numbers of positions and times differ.
std::vector<Eigen::Vector3d> deskew_points(std::span<const Eigen::Vector3d> positions, std::span<const double> times,
                                           const ScanMotion& motion);

/// The scan with its points deskewed; as it is where it has no times or the motion is zero.
PointCloud deskew(PointCloud scan, const ScanMotion& motion);

}  // namespace vdbmap::registration
