// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "tools/simulator/street_layout.h"

namespace vdbmap::simulator {

/// A piece of a street that is driven from one station [m] to another, perhaps against its direction.
struct Leg {
  std::size_t street;
  double from;
  double to;
};

/// A way through one street or several: a line with a length, and places beside it. Refers to layouts that must outlive
/// it.
class Route {
 public:
  /// Up a street: what is along the route is the street's station.
  Route(const StreetLayout& layout);  // NOLINT(google-explicit-constructor): a street is a route

  /// Along legs of straight streets of one quarter; where one leg ends in another street's axis, the way turns into it
  /// in a quarter of a circle.
  Route(const std::vector<StreetLayout>& layouts, const std::vector<Leg>& legs);

  double begin() const { return begin_; }
  double end() const { return end_; }

  /// A frame on the ground: x along the route turned by `yaw` [rad], z up; `aside` [m] to its left.
  Eigen::Isometry3d place(double along, double aside, double yaw = 0) const;

  /// Height [m, scene frame] of the ground.
  double height(double along, double aside) const;

  /// The side of the street to the left (+1) or right (-1) of the way, on a turn that of the leg before.
  const SideLayout& side(double along, double left) const;

 private:
  // A leg, or a turn, which has a centre.
  struct Piece {
    double begin;  // [m] along the route
    const StreetLayout* street;
    double from;       // [m] station at the beginning
    double direction;  // +1 with the stations, -1 against them
    double radius = 0;
    double turn = 0;  // +1 to the left, -1 to the right
    Eigen::Vector2d center = Eigen::Vector2d::Zero();
    double heading = 0;  // [rad] at the turn's beginning
  };

  const Piece& piece_at(double along) const;
  static Eigen::Vector2d point_of_turn(const Piece& piece, double along, double aside);

  std::vector<Piece> pieces_;
  double begin_;
  double end_;
};

}  // namespace vdbmap::simulator
