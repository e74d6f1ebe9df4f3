// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/parking.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace vdbmap::simulator {
namespace {

// Lengths [m].
constexpr double kParallelLength = 5.6;
constexpr double kParallelWidth = 2.0;
constexpr double kAngledLength = 5.0;
constexpr double kAngledWidth = 2.4;
constexpr double kAngle = 60 * std::numbers::pi / 180;  // [rad] of angled spaces to the kerb
constexpr double kFromDriveway = 0.4;
constexpr double kFromSideStreet = 5.0;  // where German law keeps crossings free
constexpr double kFromEnd = 3.0;
constexpr double kLongestAngledVehicle = 4.9;
constexpr double kReversedShare = 0.12;  // of the cars stand against the traffic

bool is_angled(const SideLayout& side) { return side.parking == ParkingKind::kAngled; }

// Distance of a space's middle from the axis.
double space_distance(const SideLayout& side) {
  switch (side.parking) {
    case ParkingKind::kHalfOnPavement:
      return side.kerb_offset();
    case ParkingKind::kOnPavement:
      return side.kerb_offset() + 0.25 + kParallelWidth / 2;
    default:
      return side.kerb_offset() - side.parking_width / 2;
  }
}

// A car on the right heads along the stations; into angled spaces it turns to its right.
double space_yaw(const SideLayout& side) {
  const double along = side.sign > 0 ? std::numbers::pi : 0;
  return is_angled(side) ? along - kAngle : along;
}

bool may_park(const SideLayout& side, const Interval& place) {
  for (const Interval& island : side.islands) {
    if (island.meets(place, kFromDriveway)) return false;
  }
  for (const Lot& lot : side.lots) {
    if (lot.kind == LotKind::kDriveway && lot.along.meets(place, kFromDriveway)) return false;
    if (lot.kind == LotKind::kSideStreet && lot.along.meets(place, kFromSideStreet)) return false;
  }
  return true;
}

void append_spaces(std::vector<ParkingSpace>& spaces, const StreetLayout& layout, std::size_t index) {
  const SideLayout& side = layout.sides[index];
  if (side.parking == ParkingKind::kNone) return;
  const double pitch = is_angled(side) ? kAngledWidth / std::sin(kAngle) : kParallelLength;
  // An angled space reaches further along the kerb than its pitch.
  const double overhang = is_angled(side) ? (kAngledLength * std::cos(kAngle)) / 2 : 0;
  double station = kFromEnd;
  while (station + pitch <= layout.length - kFromEnd) {
    const Interval place = {station, station + pitch};
    if (!may_park(side, {place.begin - overhang, place.end + overhang})) {
      station += 0.25;
      continue;
    }
    spaces.push_back({index, place.middle(), space_distance(side), space_yaw(side),
                      is_angled(side) ? kAngledLength : kParallelLength,
                      is_angled(side) ? kAngledWidth : kParallelWidth});
    station = place.end;
  }
}

MaterialId make_paint(World& world, Random& random) {
  const std::array<Eigen::Vector3f, 8> colors = {{{.08F, .08F, .09F},
                                                  {.30F, .31F, .33F},
                                                  {.55F, .57F, .58F},
                                                  {.75F, .76F, .77F},
                                                  {.93F, .93F, .92F},
                                                  {.13F, .20F, .42F},
                                                  {.55F, .08F, .09F},
                                                  {.20F, .30F, .24F}}};
  const std::array<float, 8> reflectances = {.08F, .20F, .35F, .45F, .65F, .30F, .40F, .25F};
  const std::array<std::size_t, 12> by_share = {0, 0, 0, 1, 1, 2, 3, 4, 4, 5, 6, 7};
  const std::size_t color = by_share[random.index(by_share.size())];
  return world.add_material({SurfaceClass::kCar, colors[color], reflectances[color], 0, 0.45F});
}

// A car stands on its four wheels, two of them perhaps on the pavement.
Eigen::Isometry3d stand_on_ground(const StreetLayout& layout, double station, double offset, double yaw,
                                  const VehicleShape& shape) {
  const auto height = [&](double x, double y) {
    return layout.ground_height(station + std::cos(yaw) * x - std::sin(yaw) * y,
                                offset + std::sin(yaw) * x + std::cos(yaw) * y);
  };
  const double x = shape.wheelbase / 2;
  const double y = shape.track() / 2;
  const double front_left = height(x, y), front_right = height(x, -y), rear_left = height(-x, y),
               rear_right = height(-x, -y);
  const double rise = (front_left + front_right - rear_left - rear_right) / (4 * x);
  const double bank = (front_left + rear_left - front_right - rear_right) / (4 * y);
  Eigen::Isometry3d frame = layout.place(station, offset, yaw);
  frame.translation().z() = (front_left + front_right + rear_left + rear_right) / 4;
  frame.rotate(Eigen::AngleAxisd(-std::atan(rise), Eigen::Vector3d::UnitY()));
  frame.rotate(Eigen::AngleAxisd(std::atan(bank), Eigen::Vector3d::UnitX()));
  return frame;
}

// Nobody parks in the middle of a space, nor quite straight.
ParkedVehicle park(World& world, const StreetLayout& layout, const ParkingSpace& space, std::size_t index,
                   Random& random) {
  const SideLayout& side = layout.sides[space.side];
  const double longest = is_angled(side) ? kLongestAngledVehicle : space.length - 0.1;
  const VehicleShape shape = make_vehicle_shape(longest, random);
  const double play = (space.length - shape.length) / 2 - 0.05;  // so that cars never touch
  const double along = is_angled(side) ? 0.0 : std::clamp(random.normal(0, 0.2), -play, play);
  const double aside = std::clamp(random.normal(0, 0.05), -0.08, 0.08);
  const bool is_reversed = random.chance(kReversedShare);
  const double yaw =
      space.yaw + (is_reversed ? std::numbers::pi : 0) + 0.012 * std::clamp(random.normal(0, 1), -2., 2.);
  ParkedVehicle vehicle{0, shape, make_paint(world, random), {}, index};
  vehicle.scene_from_vehicle =
      stand_on_ground(layout, space.station + along, side.sign * (space.distance + aside), yaw, shape);
  vehicle.object = world.add_object({name_of(shape.body), vehicle.scene_from_vehicle.translation()});
  return vehicle;
}

// The chance that keeps the share of taken spaces the same over the epochs.
double arrival_chance(const StreetOptions& options, int epoch) {
  if (epoch == 0) return options.occupancy;
  const double leaving = options.occupancy * options.turnover;
  const double empty = 1 - options.occupancy + leaving;
  return empty > 0 ? leaving / empty : 0;
}

}  // namespace

Parking make_parking(World& world, const StreetLayout& layout, const StreetOptions& options) {
  Random random(hash(options.seed, 31));
  Parking parking;
  for (const std::size_t side : {0, 1}) append_spaces(parking.spaces, layout, side);
  std::vector<std::optional<std::size_t>> state(parking.spaces.size());
  for (int epoch = 0; epoch < options.num_epochs; ++epoch) {
    for (std::size_t i = 0; i < state.size(); ++i) {
      if (state[i] && random.chance(options.turnover)) state[i].reset();
      if (state[i] || !random.chance(arrival_chance(options, epoch))) continue;
      // A place that was just left may be taken by another car.
      state[i] = parking.vehicles.size();
      parking.vehicles.push_back(park(world, layout, parking.spaces[i], i, random));
    }
    parking.vehicle_in_space.push_back(state);
  }
  return parking;
}

}  // namespace vdbmap::simulator
