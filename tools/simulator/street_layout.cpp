// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/street_layout.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/simulator/lots.h"

namespace vdbmap::simulator {
namespace {

constexpr double kCrossSlope = 0.025;     // of the carriageway, from its crown down to the gutter
constexpr double kKerbHeight = 0.12;      // [m]
constexpr double kPavementSlope = 0.02;   // up from the kerb
constexpr double kSlopedWidth = 8;        // [m] behind the kerb; level from there on
constexpr double kIslandLength = 2.0;     // [m]
constexpr double kRoadRoughness = 0.003;  // [m]
constexpr std::size_t kHouseTypes = 4;    // on a side
constexpr double kRoughness = 0.006;      // [m] of everything else

// Waves of a few metres, without a period shorter than the ground's triangles.
double bumps(double station, double offset) {
  return (std::sin(1.31 * station + 0.7 * offset) + std::sin(0.83 * station - 1.1 * offset + 1.3) +
          std::sin(0.37 * station + 0.29 * offset + 2.1)) /
         3;
}

ParkingKind choose_parking(Random& random, bool may_be_empty) {
  const double choice = random.uniform(0, 1);
  if (choice < 0.45) return ParkingKind::kParallel;
  if (choice < 0.68) return ParkingKind::kHalfOnPavement;
  if (choice < 0.78) return ParkingKind::kOnPavement;
  if (choice < 0.92 || !may_be_empty) return ParkingKind::kAngled;
  return ParkingKind::kNone;
}

Housing choose_housing(Random& random) {
  const double choice = random.uniform(0, 1);
  if (choice < 0.45) return Housing::kTerraced;
  return choice < 0.65 ? Housing::kBlock : Housing::kDetached;
}

double parking_width(ParkingKind kind) {
  if (kind == ParkingKind::kParallel) return 2.1;
  return kind == ParkingKind::kAngled ? 5.0 : 0.0;
}

double pavement_width(ParkingKind kind, Random& random) {
  const double for_people = random.uniform(1.9, 2.6);
  if (kind == ParkingKind::kHalfOnPavement) return for_people + 1.0;
  return kind == ParkingKind::kOnPavement ? for_people + 2.2 : for_people;
}

double garden_depth(Housing housing, Random& random) {
  if (housing != Housing::kBlock) return random.uniform(3.0, 5.5);
  return random.chance(0.5) ? 0.0 : random.uniform(1.6, 2.6);
}

// Trees that stand between the cars, every few spaces.
std::vector<Interval> make_islands(const SideLayout& side, double street_length, Random& random) {
  std::vector<Interval> islands;
  if (side.parking_width == 0) return islands;
  // Three or four cars stand between two of them.
  const double spacing = (random.chance(0.5) ? 17.8 : 23.4) + kIslandLength;
  for (double station = random.uniform(4, spacing); station < street_length; station += spacing) {
    const Interval island = {station, station + kIslandLength};
    if (side.is_plain(island, 1)) islands.push_back(island);
  }
  return islands;
}

SideLayout make_side(double sign, bool may_be_empty, Random& random) {
  SideLayout side;
  side.sign = sign;
  side.parking = choose_parking(random, may_be_empty);
  side.housing = choose_housing(random);
  const bool narrows = side.parking == ParkingKind::kHalfOnPavement;
  side.lane_width = random.uniform(3.1, 3.7) + (narrows ? 1.1 : 0.0);
  side.parking_width = parking_width(side.parking);
  side.pavement_width = pavement_width(side.parking, random);
  side.house_types = make_house_types(side.housing, kHouseTypes, random);
  side.garden_depth = garden_depth(side.housing, random);
  return side;
}

// Crossings have neither crown nor roughness of their own: 0 within one, 1 from 6 m outside on.
double calm(const SideLayout& side, double station) {
  double share = 1;
  for (const Lot& lot : side.lots) {
    if (lot.kind != LotKind::kCrossing) continue;
    const double outside = std::max({lot.along.begin - station, station - lot.along.end, 0.0});
    share = std::min(share, outside / 6);
  }
  return share;
}

// Both sides may have their side street at the same place: then it is a crossing, with a view along both streets.
void plan_rough_lots(StreetLayout& layout, Random& random) {
  const bool has_crossroads = random.chance(0.5);
  const double common = random.uniform(0.25, 0.75) * layout.length;
  for (SideLayout& side : layout.sides) {
    LotPlan plan;
    if (layout.length >= 80) plan.side_street = has_crossroads ? common : random.uniform(0.15, 0.85) * layout.length;
    side.lots = make_rough_lots(side, {layout.begin(), layout.end()}, plan, random);
    add_islands(side, layout.length, random);
  }
}

StreetLayout make_rough_layout(const StreetOptions& options) {
  Random random(hash(options.seed, 1));
  StreetLayout layout;
  layout.axis = make_rough_axis(random);
  layout.length = options.length;
  layout.margin = options.margin;
  layout.is_ideal = false;
  layout.ground_depth = 130;
  layout.scenery_depth = 130;
  layout.sides = {make_rough_side(+1, true, random), make_rough_side(-1, false, random)};
  plan_rough_lots(layout, random);
  return layout;
}

}  // namespace

SideLayout make_rough_side(double sign, bool may_be_empty, Random& random) {
  SideLayout side = make_side(sign, may_be_empty, random);
  // Narrow ones where two cars hardly pass, wide ones with room for a tram.
  const double choice = random.uniform(0, 1);
  if (choice < 0.2) side.lane_width = random.uniform(2.6, 3.1);
  if (choice > 0.75) side.lane_width = random.uniform(3.8, 5.5);
  if (random.chance(0.4)) side.pavement_width += random.uniform(0.3, 2.5);
  if (side.housing != Housing::kBlock && random.chance(0.5)) side.garden_depth = random.uniform(4, 9);
  return side;
}

void add_islands(SideLayout& side, double street_length, Random& random) {
  side.islands = make_islands(side, street_length, random);
}

double StreetLayout::ground_height(double station, double offset) const {
  const SideLayout& side = side_of(offset);
  const double distance = std::abs(offset);
  const double kerb = side.kerb_offset();
  const double calmness = calm(side, station);
  double height = axis.hills ? axis.hills->height(axis.point(station, offset)) : axis.height(station);
  height -= calmness * kCrossSlope * std::min(distance, kerb);
  height += calmness * (distance > kerb ? kRoughness : kRoadRoughness) * bumps(station, offset);
  if (distance > kerb) {
    const double sloped = std::min(distance - kerb, kSlopedWidth);
    height += side.kerb_share(station) * (kKerbHeight + kPavementSlope * sloped);
  }
  return height;
}

Eigen::Isometry3d StreetLayout::place(double station, double offset, double yaw) const {
  const Eigen::Vector2d point = axis.point(station, offset);
  Eigen::Isometry3d frame(Eigen::AngleAxisd(axis.heading_at(station) + yaw, Eigen::Vector3d::UnitZ()));
  frame.translation() << point, ground_height(station, offset);
  return frame;
}

Eigen::Isometry3d StreetLayout::place_on_side(const SideLayout& side, double station, double distance) const {
  return place(station, side.sign * distance, side.sign > 0 ? 0 : std::numbers::pi);
}

Eigen::Isometry3d StreetLayout::place_lot(const SideLayout& side, const Lot& lot, double distance) const {
  Eigen::Isometry3d frame = place_on_side(side, side.sign > 0 ? lot.along.begin : lot.along.end, distance);
  frame.translation().z() = ground_height(lot.along.middle(), side.sign * distance);
  return frame;
}

StreetLayout make_layout(const StreetOptions& options) {
  options.check();
  if (!options.is_ideal) return make_rough_layout(options);
  Random random(hash(options.seed, 1));
  StreetLayout layout;
  layout.axis = make_axis(random);
  layout.length = options.length;
  layout.margin = options.margin;
  layout.sides = {make_side(+1, true, random), make_side(-1, false, random)};
  for (SideLayout& side : layout.sides) {
    side.lots = make_lots(side, {layout.begin(), layout.end()}, layout.length, random);
    side.islands = make_islands(side, layout.length, random);
  }
  return layout;
}

}  // namespace vdbmap::simulator
