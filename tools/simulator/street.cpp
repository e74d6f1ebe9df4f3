// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/street.h"

#include <cmath>

#include "tools/simulator/ground.h"
#include "tools/simulator/lot_scenery.h"
#include "tools/simulator/passers_by.h"
#include "tools/simulator/pavement.h"
#include "tools/simulator/things/large_vehicles.h"
#include "tools/simulator/vehicle_model.h"

namespace vdbmap::simulator {
namespace {

constexpr double kBareShare = 0.04;  // of the leaves hangs on in winter

// Another number for each street of a quarter; the first has the seed itself.
std::uint64_t seed_of(const Street& street, std::size_t index) {
  return index == 0 ? street.options.seed : hash(street.options.seed, index);
}

void draw_lasting(Street& street, std::size_t index) {
  const StreetLayout& layout = street.layouts[index];
  Random random(hash(seed_of(street, index), 41));
  add_ground(street.world, street.lasting, layout);
  for (const SideLayout& side : layout.sides) {
    for (const Lot& lot : side.lots) add_lot(street.world, street.lasting, layout, side, lot, street.trees);
  }
  add_pavement(street.world, street.lasting, layout, street.trees, random);
}

// Things of all streets, and which spaces they block.
void place_all_things(Street& street) {
  Parking& parking = street.parking;
  for (std::size_t i = 0; i < street.layouts.size(); ++i) {
    const auto things = place_things(street.world, street.layouts[i], i, parking, street.options, seed_of(street, i));
    street.things.insert(street.things.end(), things.begin(), things.end());
  }
  parking.thing_in_space.assign(static_cast<std::size_t>(street.options.num_epochs),
                                std::vector<std::optional<ObjectId>>(parking.spaces.size()));
  for (const PlacedThing& thing : street.things) {
    if (thing.space) parking.thing_in_space[static_cast<std::size_t>(thing.epoch)][*thing.space] = thing.object;
  }
}

void draw_vehicle(Street& street, Mesh& mesh, const ParkedVehicle& vehicle) {
  const Brush paint{&mesh, vehicle.scene_from_vehicle, vehicle.paint, vehicle.object};
  add_any_vehicle(paint, vehicle.shape, street.world);
  if (vehicle.open_door == 0) return;
  const double side = vehicle.open_door > 0 ? 1 : -1;
  add_open_door(paint, vehicle.shape, side, std::abs(vehicle.open_door),
                street.world.vehicle(class_of(vehicle.shape.body)));
}

Mesh draw_changing(Street& street, int epoch) {
  Mesh mesh;
  const bool is_bare = is_winter(street.options, epoch);
  for (const Tree& tree : street.trees) add_crown(mesh, tree, epoch, is_bare ? kBareShare : 1);
  for (const ParkedVehicle* vehicle : street.vehicles(epoch)) draw_vehicle(street, mesh, *vehicle);
  for (std::size_t i = 0; i < street.layouts.size(); ++i) {
    add_passers_by(street.world, mesh, street.layouts[i], epoch, seed_of(street, i));
  }
  draw_changing_things(street.world, mesh, street.things, epoch, is_bare);
  return mesh;
}

}  // namespace

Mesh Street::mesh(int epoch) const {
  Mesh all = lasting;
  all.append(changing.at(static_cast<std::size_t>(epoch)));
  return all;
}

std::vector<const ParkedVehicle*> Street::vehicles(int epoch) const {
  std::vector<const ParkedVehicle*> found;
  for (const auto& vehicle : parking.vehicle_in_space.at(static_cast<std::size_t>(epoch))) {
    if (vehicle) found.push_back(&parking.vehicles[*vehicle]);
  }
  for (const std::size_t vehicle : parking.elsewhere.at(static_cast<std::size_t>(epoch))) {
    found.push_back(&parking.vehicles[vehicle]);
  }
  return found;
}

Street make_street(const StreetOptions& options) {
  options.check();
  Street street;
  street.options = options;
  if (options.is_quarter()) {
    const Quarter quarter = make_quarter(options);
    street.layouts = quarter.layouts;
    street.crossings = quarter.crossings;
    street.tour = quarter.tour;
    add_crossings(street.world, street.lasting, quarter);
  } else {
    street.layouts = {make_layout(options)};
  }
  for (std::size_t i = 0; i < street.layouts.size(); ++i) draw_lasting(street, i);
  for (std::size_t i = 0; i < street.layouts.size(); ++i) {
    append_parking(street.parking, street.world, street.layouts[i], i, options);
  }
  if (!options.is_ideal) place_all_things(street);
  draw_lasting_things(street.world, street.lasting, street.things);
  for (int epoch = 0; epoch < options.num_epochs; ++epoch) street.changing.push_back(draw_changing(street, epoch));
  return street;
}

}  // namespace vdbmap::simulator
