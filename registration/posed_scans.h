// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "registration/odometry/deskew.h"
#include "registration/odometry/scan_clock.h"
#include "vdbmap/core/posed_cloud.h"

namespace vdbmap::registration {

/// Deskews scans whose poses are known, those of their first points, with the motion from each to the next, and hands
/// them on in their order with the places from which their points were measured. Scans without usable times stay as
/// they are, measured from one place.
class PosedScans {
 public:
  using Receiver = std::function<void(const PosedCloud& scan)>;

  explicit PosedScans(Receiver receiver) : receiver_(std::move(receiver)) {}

  /// The next scan of the sequence, as the sensor delivers it.
  void add(PointCloud scan, const Eigen::Isometry3d& map_from_scan);

  /// So many scans of the sequence are left out before the next.
  void pass_over(std::size_t num_scans);

  /// There is no scan more: hands on the last, with the motion that led to it.
  void finish();

 private:
  struct Waiting {
    PointCloud scan;
    Eigen::Isometry3d map_from_scan;
    std::optional<double> first_time;  // [s] by its time stamps
    double elapsed = 0;                // [s] since the first scan
  };

  void hand_on();

  Receiver receiver_;
  ScanClock clock_;
  std::optional<Waiting> waiting_;
  Vector6d twist_ = Vector6d::Zero();
};

}  // namespace vdbmap::registration
