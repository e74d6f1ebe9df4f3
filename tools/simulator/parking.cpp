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
constexpr double kCarParkWidth = 2.5;
constexpr double kAngle = 60 * std::numbers::pi / 180;  // [rad] of angled spaces to the kerb
constexpr double kFromDriveway = 0.4;
constexpr double kFromSideStreet = 5.0;  // where German law keeps crossings free
constexpr double kFromEnd = 3.0;
constexpr double kLongestAngledVehicle = 4.9;
constexpr double kReversedShare = 0.12;  // of the cars stand against the traffic
constexpr double kOpenDoorShare = 0.05;  // of the cars

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
    const bool is_crossing = lot.kind == LotKind::kSideStreet || lot.kind == LotKind::kCrossing;
    if (is_crossing && lot.along.meets(place, kFromSideStreet)) return false;
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

// Two rows of spaces, noses to a lane between them.
void append_car_parks(std::vector<ParkingSpace>& spaces, const StreetLayout& layout, std::size_t index) {
  const SideLayout& side = layout.sides[index];
  for (const Lot& lot : side.lots) {
    if (lot.kind != LotKind::kCarPark) continue;
    for (double station = lot.along.begin + 2; station + kCarParkWidth < lot.along.end - 1; station += kCarParkWidth) {
      for (const double row : {3.5, 15.0}) {
        const double yaw = side.sign * (row < 10 ? 1 : -1) * std::numbers::pi / 2;
        spaces.push_back(
            {index, station + kCarParkWidth / 2, side.facade_offset() + row, yaw, kAngledLength, kCarParkWidth, true});
      }
    }
  }
}

// A place where a vehicle may stand that is no parking space.
struct Spot {
  double station;
  double offset;   // [m] from the axis, left positive
  double yaw;      // [rad]
  double longest;  // [m]
  double share;    // of the epochs in which somebody stands there
};

void append_spots(std::vector<Spot>& spots, const StreetLayout& layout, const SideLayout& side, Random& random) {
  using std::numbers::pi;
  const double away = side.sign * pi / 2;
  for (const Lot& lot : side.lots) {
    if (lot.kind == LotKind::kDriveway && side.garden_depth >= 3 && side.housing != Housing::kBlock) {
      spots.push_back({lot.along.middle(), side.sign * (side.pavement_offset() + 2.7), -away, 4.8, 0.5});
    }
    if (lot.kind != LotKind::kSideStreet) continue;
    for (double distance = side.facade_offset() + 10; distance < layout.scenery_depth - 15; distance += 6.2) {
      const bool is_left = random.chance(0.5);
      const double station = is_left ? lot.along.begin + 1.3 : lot.along.end - 1.3;
      spots.push_back({station, side.sign * distance, is_left ? away : -away, 5.5, 0.45});
    }
  }
  // Trucks and trailers stand where nobody else parks: before and behind the spaces.
  const double along = side.sign > 0 ? pi : 0, beside = side.kerb_offset() - 1.3;
  for (const double station : {-9.0, layout.length + 9}) {
    if (layout.margin >= 20 && side.parking != ParkingKind::kNone && may_park(side, {station - 5, station + 5})) {
      spots.push_back({station, side.sign * beside, along, 9.0, 0.3});
    }
  }
  // A delivery in the second row, on the side that the surveys do not drive on; a quarter's drive uses both.
  if (side.sign > 0 && !layout.axis.hills && random.chance(0.5)) {
    spots.push_back({random.uniform(0.1, 0.9) * layout.length, side.lane_width - 1.1, pi, 6.5, 0.5});
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

// A vehicle of any kind; the frame is the place's.
ParkedVehicle stand(World& world, const StreetLayout& layout, const Spot& spot, Random& random) {
  const VehicleShape shape = make_any_shape(spot.longest, random);
  ParkedVehicle vehicle{0, shape, world.add_paint(class_of(shape.body), random), {}, kNoSpace};
  const double yaw = spot.yaw + (random.chance(kReversedShare) ? std::numbers::pi : 0) +
                     0.02 * std::clamp(random.normal(0, 1), -2., 2.);
  vehicle.scene_from_vehicle = stand_on_ground(layout, spot.station, spot.offset, yaw, shape);
  vehicle.object = world.add_object({name_of(shape.body), vehicle.scene_from_vehicle.translation()});
  if (shape.body < VehicleBody::kBoxVan && random.chance(kOpenDoorShare)) {
    vehicle.open_door = (random.chance(0.5) ? 1 : -1) * random.uniform(0.5, 1.2);
  }
  return vehicle;
}

// The same for a space: not in its middle, nor quite straight.
ParkedVehicle park_any(World& world, const StreetLayout& layout, const ParkingSpace& space, std::size_t index,
                       Random& random) {
  const SideLayout& side = layout.sides[space.side];
  const bool is_across = space.in_car_park || is_angled(side);
  Spot spot = {space.station, side.sign * (space.distance + std::clamp(random.normal(0, 0.07), -0.15, 0.15)), space.yaw,
               is_across ? kLongestAngledVehicle : space.length - 0.1, 1};
  if (!is_across) spot.station += random.uniform(-0.2, 0.2);
  ParkedVehicle vehicle = stand(world, layout, spot, random);
  vehicle.space = index;
  return vehicle;
}

// The chance that keeps the share of taken spaces the same over the epochs.
double arrival_chance(const StreetOptions& options, int epoch) {
  if (epoch == 0) return options.occupancy;
  const double leaving = options.occupancy * options.turnover;
  const double empty = 1 - options.occupancy + leaving;
  return empty > 0 ? leaving / empty : 0;
}

std::vector<ParkingSpace> spaces_of(const StreetLayout& layout, std::size_t street) {
  std::vector<ParkingSpace> spaces;
  for (const std::size_t side : {0, 1}) {
    append_spaces(spaces, layout, side);
    if (!layout.is_ideal) append_car_parks(spaces, layout, side);
  }
  for (ParkingSpace& space : spaces) space.street = street;
  return spaces;
}

// Who stands elsewhere in each epoch.
void append_elsewhere(Parking& parking, World& world, const StreetLayout& layout, const StreetOptions& options,
                      Random& random) {
  std::vector<Spot> spots;
  for (const SideLayout& side : layout.sides) append_spots(spots, layout, side, random);
  for (const Spot& spot : spots) {
    constexpr auto kNobody = static_cast<std::size_t>(-1);
    std::size_t standing = kNobody;
    for (std::size_t epoch = 0; epoch < parking.elsewhere.size(); ++epoch) {
      if (standing != kNobody && random.chance(options.turnover)) standing = kNobody;
      if (standing == kNobody && random.chance(spot.share * options.occupancy)) {
        standing = parking.vehicles.size();
        parking.vehicles.push_back(stand(world, layout, spot, random));
      }
      if (standing != kNobody) parking.elsewhere[epoch].push_back(standing);
    }
  }
}

}  // namespace

void append_parking(Parking& parking, World& world, const StreetLayout& layout, std::size_t street,
                    const StreetOptions& options) {
  Random random(hash(street == 0 ? options.seed : hash(options.seed, street), 31));
  const auto num_epochs = static_cast<std::size_t>(options.num_epochs);
  const std::size_t first = parking.spaces.size();
  const std::vector<ParkingSpace> spaces = spaces_of(layout, street);
  parking.spaces.insert(parking.spaces.end(), spaces.begin(), spaces.end());
  parking.vehicle_in_space.resize(num_epochs);
  parking.elsewhere.resize(num_epochs);
  std::vector<std::optional<std::size_t>> state(spaces.size());
  for (std::size_t epoch = 0; epoch < num_epochs; ++epoch) {
    for (std::size_t i = 0; i < state.size(); ++i) {
      if (state[i] && random.chance(options.turnover)) state[i].reset();
      if (state[i] || !random.chance(arrival_chance(options, static_cast<int>(epoch)))) continue;
      // A place that was just left may be taken by another car.
      state[i] = parking.vehicles.size();
      parking.vehicles.push_back(layout.is_ideal ? park(world, layout, spaces[i], first + i, random)
                                                 : park_any(world, layout, spaces[i], first + i, random));
    }
    auto& of_epoch = parking.vehicle_in_space[epoch];
    of_epoch.insert(of_epoch.end(), state.begin(), state.end());
  }
  if (!layout.is_ideal) append_elsewhere(parking, world, layout, options, random);
}

Parking make_parking(World& world, const StreetLayout& layout, const StreetOptions& options) {
  Parking parking;
  append_parking(parking, world, layout, 0, options);
  return parking;
}

}  // namespace vdbmap::simulator
