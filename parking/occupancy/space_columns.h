// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "parking/ground_plan.h"
#include "parking/spaces/parking_space.h"

namespace vdbmap::parking {

/// The room over a space in which a vehicle would stand, 0.3 to 1.5 m above the ground, as columns of some 0.5 m by 0.5
/// m whose middles lie inside its outline.
class SpaceColumns {
 public:
  static constexpr double kEdge = 0.5;              ///< [m] some: a whole number of columns fills length and width
  static constexpr double kLow = 0.3, kHigh = 1.5;  ///< [m] above the ground
  static constexpr double kSill = 0.9;              ///< [m] above it light goes through windows, and over bonnets
  static constexpr double kShortestPass = 0.25;     ///< [m] a ray that is shorter in a column says nothing of it

  SpaceColumns(const ParkingSpace& space, const GroundPlane& ground);

  /// How many columns there are.
  std::size_t size() const { return num_columns_; }

  /// Along and across the rectangle around the space, and height above the ground [m]: straight lines stay straight.
  Eigen::Vector3d in_frame(const Eigen::Vector3d& point) const {
    const Eigen::Vector2d from_corner = point.head<2>() - corner_;
    return {from_corner.dot(along_), from_corner.dot(across_), point.z() - ground_.height_at(point.head<2>())};
  }

  /// The column at a place of the frame; nothing outside of the space.
  std::optional<std::size_t> column_at(double u, double v) const;

  /// Whether columns lie on all eight sides of it. A car that parks in the space stands there too: spaces are less than
  /// a metre wider than cars.
  bool is_inner(std::size_t column) const { return is_inner_[column] != 0; }

  /// The middle of each column [m, local frame, on the ground].
  std::vector<Eigen::Vector3d> middles() const;

  /// Size of a column along and across the rectangle [m].
  Eigen::Vector2d edges() const { return {edge_u_, edge_v_}; }

  /// Calls body(column) for each column in which a straight way from `from` to `to` [m, local frame] is at least 0.25 m
  /// long between 0.3 m and `high` [m] above the ground. A closed form: boxes of the frame are cut with the line (Kay &
  /// Kajiya 1986).
  template <typename Body>
  void for_each_passed(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double high, const Body& body) const;

  /// Between which heights the ground lies around the space [m, local frame].
  double lowest_ground() const { return ground_.height_at(middle_) - ground_.slope.norm() * radius_; }
  double highest_ground() const { return ground_.height_at(middle_) + ground_.slope.norm() * radius_; }

  /// A place around which the rectangle lies, and how far it reaches [m].
  const Eigen::Vector2d& middle() const { return middle_; }
  double radius() const { return radius_; }

 private:
  static constexpr std::int32_t kOutside = -1;

  Eigen::Vector2d middle_, corner_, along_, across_;  // of the rectangle around the space
  double radius_;
  GroundPlane ground_;
  std::int32_t count_u_, count_v_;
  double edge_u_, edge_v_;             // [m]
  std::vector<std::int32_t> columns_;  // by u, then v: number of the column, or kOutside
  std::size_t num_columns_ = 0;
  std::vector<std::uint8_t> is_inner_;  // by column
};

/// The part of a line from 0 to 1 that lies in a slab.
struct LinePart {
  double begin = 0, end = 1;

  void cut(double from, double step, double low, double high) {
    if (step == 0) {
      if (from < low || from > high) end = begin - 1;
      return;
    }
    const double a = (low - from) / step, b = (high - from) / step;
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
};

template <typename Body>
void SpaceColumns::for_each_passed(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double high,
                                   const Body& body) const {
  const Eigen::Vector3d a = in_frame(from), step = in_frame(to) - a;
  LinePart room;
  room.cut(a.z(), step.z(), kLow, high);
  room.cut(a.x(), step.x(), 0, edge_u_ * count_u_);
  room.cut(a.y(), step.y(), 0, edge_v_ * count_v_);
  const double length = (to - from).norm();
  if ((room.end - room.begin) * length < kShortestPass) return;

  const auto cell = [](double value, double edge, std::int32_t count) {
    return std::clamp(static_cast<std::int32_t>(std::floor(value / edge)), 0, count - 1);
  };
  const Eigen::Vector3d first = a + room.begin * step, last = a + room.end * step;
  const auto [low_u, high_u] = std::minmax({cell(first.x(), edge_u_, count_u_), cell(last.x(), edge_u_, count_u_)});
  const auto [low_v, high_v] = std::minmax({cell(first.y(), edge_v_, count_v_), cell(last.y(), edge_v_, count_v_)});
  for (std::int32_t u = low_u; u <= high_u; ++u) {
    LinePart slab = room;
    slab.cut(a.x(), step.x(), u * edge_u_, (u + 1) * edge_u_);
    for (std::int32_t v = low_v; v <= high_v; ++v) {
      const std::int32_t column = columns_[static_cast<std::size_t>(u * count_v_ + v)];
      LinePart part = slab;
      part.cut(a.y(), step.y(), v * edge_v_, (v + 1) * edge_v_);
      if (column != kOutside && (part.end - part.begin) * length >= kShortestPass) {
        body(static_cast<std::size_t>(column));
      }
    }
  }
}

}  // namespace vdbmap::parking
