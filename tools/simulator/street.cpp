// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/street.h"

#include "tools/simulator/ground.h"
#include "tools/simulator/lot_scenery.h"
#include "tools/simulator/passers_by.h"
#include "tools/simulator/pavement.h"
#include "tools/simulator/vehicle_model.h"

namespace vdbmap::simulator {
namespace {

void draw_lasting(Street& street) {
  Random random(hash(street.options.seed, 41));
  add_ground(street.world, street.lasting, street.layout);
  for (const SideLayout& side : street.layout.sides) {
    for (const Lot& lot : side.lots) add_lot(street.world, street.lasting, street.layout, side, lot, street.trees);
  }
  add_pavement(street.world, street.lasting, street.layout, street.trees, random);
}

Mesh draw_changing(Street& street, int epoch) {
  Mesh mesh;
  for (const Tree& tree : street.trees) add_crown(mesh, tree, epoch);
  for (const ParkedVehicle* vehicle : street.vehicles(epoch)) {
    add_vehicle({&mesh, vehicle->scene_from_vehicle, vehicle->paint, vehicle->object}, vehicle->shape,
                street.world.standard());
  }
  add_passers_by(street.world, mesh, street.layout, epoch, street.options.seed);
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
  return found;
}

Street make_street(const StreetOptions& options) {
  Street street{options, make_layout(options), {}, {}, {}, {}, {}};
  draw_lasting(street);
  street.parking = make_parking(street.world, street.layout, options);
  for (int epoch = 0; epoch < options.num_epochs; ++epoch) street.changing.push_back(draw_changing(street, epoch));
  return street;
}

}  // namespace vdbmap::simulator
