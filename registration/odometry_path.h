// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include <Eigen/Geometry>

namespace vdbmap::registration {

/// Where odometry puts a scan of a sequence.
struct PathPose {
  Eigen::Isometry3d odometry_from_scan = Eigen::Isometry3d::Identity();
  bool follows = true;  ///< odometry leads here from the scan before; false at the first scan and after a gap
};

/// The motion from one scan to another, a_from_b.
inline Eigen::Isometry3d step_between(const PathPose& a, const PathPose& b) {
  return a.odometry_from_scan.inverse() * b.odometry_from_scan;
}

/// The scan from which odometry leads to this one, going forward or backward along the path; none at an end or a gap.
inline std::optional<std::size_t> linked_scan(std::span<const PathPose> path, std::size_t scan, bool is_forward) {
  if (is_forward) return scan > 0 && path[scan].follows ? std::optional(scan - 1) : std::nullopt;
  const bool has_next = scan + 1 < path.size() && path[scan + 1].follows;
  return has_next ? std::optional(scan + 1) : std::nullopt;
}

}  // namespace vdbmap::registration
