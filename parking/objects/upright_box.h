// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>

#include <Eigen/Core>

namespace vdbmap::parking {

/// A box that stands upright [m].
struct UprightBox {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double length = 0;  ///< the longer side on the ground
  double width = 0;   ///< the shorter one
  double height = 0;
  double heading = 0;  ///< [rad] of the length, from +x towards +y, 0 to pi: front and back are not told apart

  /// Along the length and across it, to the left.
  Eigen::Vector2d along() const;
  Eigen::Vector2d across() const;

  /// The four corners on the ground, against the clock.
  std::array<Eigen::Vector2d, 4> corners() const;

  /// Whether a place lies inside of it, on the ground.
  bool contains(const Eigen::Vector2d& point) const;
};

/// The box around points whose rectangle on the ground has the smallest area (CGAL's convex hull and rotating
/// calipers). The same for any order of the points. Throws std::invalid_argument without points.
UprightBox smallest_box(std::span<const Eigen::Vector3d> points);

/// The same with a given heading.
UprightBox box_of_heading(std::span<const Eigen::Vector3d> points, double heading);

/// Intersection over union of two boxes on the ground, 0 to 1.
double overlap_in_plan(const UprightBox& a, const UprightBox& b);

}  // namespace vdbmap::parking
