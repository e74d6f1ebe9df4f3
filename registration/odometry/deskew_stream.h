// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>

#include <Eigen/Geometry>

#include "registration/odometry/odometry.h"
#include "vdbmap/core/point_cloud.h"

namespace vdbmap::registration {

/// Deskews the scans of an odometry and hands them on with their poses. The first scan waits for the second, with which
/// its motion becomes known.
class DeskewStream {
 public:
  /// The motion is that which the scan was deskewed with.
  using Receiver = std::function<void(const PointCloud& deskewed_scan, const Eigen::Isometry3d& first_from_scan,
                                      const ScanMotion& motion)>;

  explicit DeskewStream(Receiver receiver) : receiver_(std::move(receiver)) {}

  /// The next scan and its step; scans that were not registered are left out.
  void add(PointCloud scan, const OdometryStep& step);

  /// There is no scan more: hands on a first one that waits.
  void finish();

 private:
  struct WaitingScan {
    PointCloud scan;
    OdometryStep step;
  };

  void hand_on(PointCloud scan, const OdometryStep& step);

  Receiver receiver_;
  bool is_first_ = true;
  std::optional<WaitingScan> waiting_;
};

}  // namespace vdbmap::registration
