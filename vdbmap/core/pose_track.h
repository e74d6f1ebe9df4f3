// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

namespace vdbmap {

/// Where a sensor was, at any time between poses that are known.
class PoseTrack {
 public:
  /// Poses with their times [s]; those without a pose, or whose time is not finite, are left out, the others sorted by
  /// time. Throws std::invalid_argument where the numbers differ, fewer than two poses are left, or two of one time
  /// differ.
  PoseTrack(const std::vector<std::optional<Eigen::Isometry3d>>& map_from_sensor, const std::vector<double>& times);

  double first_time() const { return poses_.front().time; }
  double last_time() const { return poses_.back().time; }

  /// The pose at a time: between the two poses around it the position on the straight line, the rotation about one axis
  /// at an even rate. Nothing before the first and after the last, and in gaps longer than `max_gap` [s].
  std::optional<Eigen::Isometry3d> at(double time, double max_gap = 1.0) const;

 private:
  struct Pose {
    double time;
    Eigen::Vector3d position;
    Eigen::Quaterniond rotation;
  };

  std::vector<Pose> poses_;
};

}  // namespace vdbmap
