// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/simulator/house_type.h"

namespace vdbmap::simulator {

/// A stretch of the street, by stations [m].
struct Interval {
  double begin;
  double end;

  double length() const { return end - begin; }
  double middle() const { return (begin + end) / 2; }
  /// Whether some station lies in both, or nearer than `margin` to both.
  bool meets(const Interval& other, double margin = 0) const {
    return begin - margin < other.end && other.begin < end + margin;
  }
};

/// How cars stand along a side.
enum class ParkingKind { kNone, kParallel, kHalfOnPavement, kOnPavement, kAngled };

/// "none", "parallel", "half on pavement", "on pavement", "angled".
std::string name_of(ParkingKind kind);

/// What stands on a stretch behind the pavement.
enum class LotKind {
  kHouse,
  kGap,
  kDriveway,
  kSideStreet,
  kPark,      ///< trees and bushes on grass
  kCarPark,   ///< rows of spaces
  kHall,      ///< a long wall without windows
  kOpen,      ///< nothing, and a view of 100 m
  kCrossing,  ///< of two streets of a quarter
};

/// "house", "gap", "driveway", "side street", "park", "car park", "hall", "open", "crossing".
std::string name_of(LotKind kind);

struct Lot {
  LotKind kind;
  Interval along;
  std::size_t house_type = 0;  ///< of the side's types; houses only
  std::uint64_t seed = 0;      ///< for what differs between lots of one kind
};

/// One side of the street, from the axis outwards: carriageway, parking lane, kerb, pavement, front gardens, houses.
/// Offsets [m] are distances from the axis.
struct SideLayout {
  double sign;  ///< +1 on the left of the direction of travel, -1 on its right
  ParkingKind parking;
  Housing housing;
  double lane_width;      ///< [m] of this side's half of the carriageway
  double parking_width;   ///< [m] between carriageway and kerb
  double pavement_width;  ///< [m]
  double garden_depth;    ///< [m] between pavement and houses
  std::vector<HouseType> house_types;
  std::vector<Lot> lots;          ///< in the order of stations, without gaps
  std::vector<Interval> islands;  ///< of trees in the parking lane

  double kerb_offset() const { return lane_width + parking_width; }
  double pavement_offset() const { return kerb_offset() + pavement_width; }
  double facade_offset() const { return pavement_offset() + garden_depth; }

  /// The stretches of one kind.
  std::vector<Interval> stretches(LotKind kind) const;

  /// How much of the kerb's height is left at a station: lowered at driveways, gone at side streets, 0..1.
  double kerb_share(double station) const;

  /// Whether the stretch is free of driveways and side streets and `margin` [m] away from them.
  bool is_plain(const Interval& stretch, double margin) const;
};

}  // namespace vdbmap::simulator
