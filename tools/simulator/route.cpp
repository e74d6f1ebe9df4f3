// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/route.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vdbmap::simulator {
namespace {

constexpr double kTurnRadius = 7;  // [m]

double sign(double value) { return value < 0 ? -1 : 1; }

double heading_of(const StreetLayout& street, double direction) {
  return street.axis.heading + (direction < 0 ? std::numbers::pi : 0);
}

Eigen::Vector2d unit(double angle) { return {std::cos(angle), std::sin(angle)}; }

}  // namespace

Route::Route(const StreetLayout& layout) : pieces_{{0, &layout, 0, 1}}, begin_(layout.begin()), end_(layout.end()) {}

Route::Route(const std::vector<StreetLayout>& layouts, const std::vector<Leg>& legs) : begin_(0), end_(0) {
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const bool turns_in = i > 0, turns_out = i + 1 < legs.size();
    const StreetLayout& street = layouts[legs[i].street];
    const double direction = sign(legs[i].to - legs[i].from);
    const double from = legs[i].from + (turns_in ? direction * kTurnRadius : 0);
    const double to = legs[i].to - (turns_out ? direction * kTurnRadius : 0);
    pieces_.push_back({end_, &street, from, direction});
    end_ += std::abs(to - from);
    if (!turns_out) break;
    Piece piece{end_, &street, to, direction};
    const StreetLayout& next = layouts[legs[i + 1].street];
    piece.heading = heading_of(street, direction);
    const double other = heading_of(next, sign(legs[i + 1].to - legs[i + 1].from));
    piece.turn = sign(std::sin(other - piece.heading));
    piece.radius = kTurnRadius;
    piece.center = street.axis.point(to, 0) + kTurnRadius * piece.turn * unit(piece.heading + std::numbers::pi / 2);
    pieces_.push_back(piece);
    end_ += kTurnRadius * std::numbers::pi / 2;
  }
}

const Route::Piece& Route::piece_at(double along) const {
  const auto after = std::ranges::upper_bound(pieces_, along, {}, &Piece::begin);
  return after == pieces_.begin() ? pieces_.front() : *(after - 1);
}

Eigen::Vector2d Route::point_of_turn(const Piece& piece, double along, double aside) {
  const double angle = piece.heading + piece.turn * (along - piece.begin) / piece.radius;
  return piece.center + (piece.radius * piece.turn - aside) * unit(angle - std::numbers::pi / 2);
}

Eigen::Isometry3d Route::place(double along, double aside, double yaw) const {
  const Piece& piece = piece_at(along);
  if (piece.radius == 0) {
    const double station = piece.from + piece.direction * (along - piece.begin);
    return piece.street->place(station, piece.direction * aside, piece.direction < 0 ? yaw + std::numbers::pi : yaw);
  }
  const double angle = piece.heading + piece.turn * (along - piece.begin) / piece.radius;
  Eigen::Isometry3d frame(Eigen::AngleAxisd(angle + yaw, Eigen::Vector3d::UnitZ()));
  frame.translation() << point_of_turn(piece, along, aside), height(along, aside);
  return frame;
}

double Route::height(double along, double aside) const {
  const Piece& piece = piece_at(along);
  if (piece.radius == 0) {
    return piece.street->ground_height(piece.from + piece.direction * (along - piece.begin), piece.direction * aside);
  }
  // Crossings are as the hills are.
  return piece.street->axis.hills->height(point_of_turn(piece, along, aside));
}

const SideLayout& Route::side(double along, double left) const {
  const Piece& piece = piece_at(along);
  return piece.street->side_of(piece.direction * left);
}

}  // namespace vdbmap::simulator
