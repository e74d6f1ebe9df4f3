// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "registration/localizer.h"
#include "registration/odometry/deskew_stream.h"
#include "registration/odometry/odometry.h"
#include "registration/odometry/scan_clock.h"
#include "vdbmap/core/point_cloud.h"
#include "vdbmap/store/map_windows.h"

namespace vdbmap::registration {

/// Raw scans in, poses out: odometry, deskewing and the Localizer in one. Every scan added has its place in the result,
/// also one that odometry could not use. Where odometry loses the way it begins anew, and so does the batch.
class SequenceLocalizer {
 public:
  /// As Localizer's constructor.
  explicit SequenceLocalizer(const MapWindows& map, const LocalizerOptions& options = {},
                             const OdometryOptions& odometry = {});
  SequenceLocalizer(const SequenceLocalizer&) = delete;
  SequenceLocalizer& operator=(const SequenceLocalizer&) = delete;

  /// The next scan, as the sensor delivers it.
  void add(PointCloud scan);

  /// The next scan with its pose from an odometry made before, instead of our own; nothing where that has none. Either
  /// all scans come with such a pose or none.
  void add(PointCloud scan, const std::optional<Eigen::Isometry3d>& odometry_from_scan);

  /// A scan that cannot even be read, and why.
  void skip(const std::string& reason);

  /// So many scans of the sequence are left out before the next, without a place in the result.
  void pass_over(std::size_t num_scans);

  /// The result for all scans, in their order.
  SequenceResult finish();

 private:
  // What is known of a scan before it is localized.
  struct Added {
    std::string reason;        // why odometry could not use it, or empty
    std::string time_problem;  // why it was not deskewed, or empty
  };

  void take(PointCloud scan, const OdometryStep& step);
  void begin_segment();
  void receive(const PointCloud& deskewed_scan, const Eigen::Isometry3d& odometry_from_scan, const ScanMotion& motion);
  DeskewStream new_stream();
  OdometryStep follow(const PointCloud& scan, const Eigen::Isometry3d& odometry_from_scan);

  Localizer localizer_;
  OdometryOptions odometry_options_;
  Odometry odometry_;
  ScanClock clock_;                              // of scans with given poses
  std::optional<Eigen::Isometry3d> last_given_;  // pose
  DeskewStream stream_;
  bool is_first_of_segment_ = true;
  std::vector<Added> added_;
};

}  // namespace vdbmap::registration
