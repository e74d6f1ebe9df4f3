// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>

#include <Eigen/Core>

namespace vdbmap {

/// A rectangle on the ground [m].
struct PlanRectangle {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double length = 0;  ///< the longer side
  double width = 0;   ///< the shorter one
  double yaw = 0;     ///< [rad] of the length, from +x towards +y, 0 to pi

  /// The four corners, against the clock.
  std::array<Eigen::Vector2d, 4> corners() const;
};

/// The rectangle of smallest area around points: one of its sides lies along their convex hull (Freeman & Shapira
/// 1975). The same for any order of the points. Throws std::invalid_argument without points.
PlanRectangle smallest_rectangle(std::span<const Eigen::Vector2d> points);

}  // namespace vdbmap
