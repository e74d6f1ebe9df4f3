// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/world.h"

#include <array>
#include <limits>
#include <stdexcept>
#include <utility>

namespace vdbmap::simulator {
namespace {

using enum SurfaceClass;
using Color = Eigen::Vector3f;

// Reflectances near 905 nm: asphalt and rubber are dark, plants bright (the red edge), as in the ECOSTRESS library.
void add_ground(World& world, StandardMaterials& m) {
  m.asphalt = world.add_material({kRoad, Color(.38F, .38F, .39F), .18F, 0, 0, Texture::kAsphalt});
  m.parking = world.add_material({kParking, Color(.47F, .45F, .43F), .25F, 0, 0, Texture::kSetts});
  m.kerb = world.add_material({kPavement, Color(.62F, .61F, .59F), .35F, 0, 0, Texture::kPlaster});
  m.slabs = world.add_material({kPavement, Color(.58F, .57F, .54F), .33F, 0, 0, Texture::kSlabs});
  m.setts = world.add_material({kPavement, Color(.50F, .44F, .40F), .28F, 0, 0, Texture::kSetts});
  m.grass = world.add_material({kTerrain, Color(.36F, .46F, .22F), .45F, 0, 0, Texture::kGrass});
  m.soil = world.add_material({kTerrain, Color(.36F, .29F, .22F), .25F, 0, 0, Texture::kGrass});
}

void add_buildings(World& world, StandardMaterials& m) {
  m.window_glass = world.add_material({kBuilding, Color(.30F, .36F, .42F), .06F, .70F, .8F});
  m.window_frame = world.add_material({kBuilding, Color(.90F, .90F, .88F), .60F});
  m.interior = world.add_material({kBuilding, Color(.22F, .21F, .20F), .30F});
  m.curtain = world.add_material({kBuilding, Color(.80F, .79F, .75F), .45F, .25F});
  m.door = world.add_material({kBuilding, Color(.36F, .25F, .18F), .30F, 0, .1F, Texture::kWood});
  m.stone = world.add_material({kBuilding, Color(.52F, .50F, .47F), .35F, 0, 0, Texture::kPlaster});
  m.railing = world.add_material({kBuilding, Color(.25F, .26F, .27F), .20F});
  m.roof_tiles = world.add_material({kBuilding, Color(.58F, .30F, .22F), .35F, 0, 0, Texture::kRoofTiles});
  m.dark_roof = world.add_material({kBuilding, Color(.30F, .29F, .30F), .20F, 0, 0, Texture::kRoofTiles});
  m.gutter = world.add_material({kBuilding, Color(.50F, .52F, .53F), .40F, 0, .3F});
}

void add_gardens(World& world, StandardMaterials& m) {
  m.wood = world.add_material({kFence, Color(.48F, .36F, .25F), .40F, 0, 0, Texture::kWood});
  m.metal_fence = world.add_material({kFence, Color(.20F, .28F, .22F), .25F});
  m.brick_wall = world.add_material({kFence, Color(.55F, .33F, .26F), .35F, 0, 0, Texture::kBrick});
  m.hedge = world.add_material({kVegetation, Color(.22F, .36F, .15F), .45F, 0, 0, Texture::kLeaves});
  m.leaves = world.add_material({kVegetation, Color(.32F, .48F, .18F), .50F, 0, 0, Texture::kLeaves});
  m.bark = world.add_material({kTrunk, Color(.35F, .29F, .24F), .35F, 0, 0, Texture::kWood});
}

void add_furniture(World& world, StandardMaterials& m) {
  m.steel = world.add_material({kPole, Color(.55F, .57F, .58F), .35F, 0, .2F});
  m.lamp = world.add_material({kPole, Color(.85F, .85F, .82F), .40F});
  m.sign_white = world.add_material({kTrafficSign, Color(.93F, .93F, .93F), 2.0F});
  m.sign_blue = world.add_material({kTrafficSign, Color(.10F, .25F, .65F), 1.5F});
  m.sign_red = world.add_material({kTrafficSign, Color(.75F, .10F, .12F), 1.5F});
  m.bollard = world.add_material({kPole, Color(.62F, .16F, .14F), .35F});
}

void add_vehicles(World& world, StandardMaterials& m) {
  m.car_glass = world.add_material({kCar, Color(.14F, .17F, .19F), .05F, .78F, .8F});
  m.tyre = world.add_material({kCar, Color(.10F, .10F, .10F), .06F});
  m.rim = world.add_material({kCar, Color(.66F, .67F, .68F), .40F, 0, .5F});
  m.car_interior = world.add_material({kCar, Color(.16F, .16F, .17F), .20F});
  m.car_trim = world.add_material({kCar, Color(.13F, .13F, .14F), .08F});
  m.headlight = world.add_material({kCar, Color(.80F, .82F, .84F), .80F, 0, .3F});
  m.tail_light = world.add_material({kCar, Color(.60F, .08F, .08F), 1.2F});
  m.plate = world.add_material({kCar, Color(.90F, .90F, .88F), 2.0F});
}

VehicleMaterials add_vehicle_materials(World& world, SurfaceClass label) {
  VehicleMaterials m{};
  m.glass = world.add_material({label, Color(.14F, .17F, .19F), .05F, .78F, .8F});
  m.tyre = world.add_material({label, Color(.10F, .10F, .10F), .06F});
  m.rim = world.add_material({label, Color(.66F, .67F, .68F), .40F, 0, .5F});
  m.interior = world.add_material({label, Color(.16F, .16F, .17F), .20F});
  m.trim = world.add_material({label, Color(.13F, .13F, .14F), .08F});
  m.headlight = world.add_material({label, Color(.80F, .82F, .84F), .80F, 0, .3F});
  m.tail_light = world.add_material({label, Color(.60F, .08F, .08F), 1.2F});
  m.plate = world.add_material({label, Color(.90F, .90F, .88F), 2.0F});
  return m;
}

void add_rough(World& world, StandardMaterials& m) {
  m.twigs = world.add_material({kVegetation, Color(.33F, .27F, .20F), .35F, 0, 0, Texture::kWood});
  m.snow = world.add_material({kOtherObject, Color(.90F, .91F, .93F), .70F});
  m.plaster = world.add_material({kBuilding, Color(.78F, .76F, .72F), .50F, 0, 0, Texture::kPlaster});
}

// Numbers are 16 bits wide in Triangle and in .label files.
std::uint16_t next_number(std::size_t count, const char* what) {
  if (count < std::numeric_limits<std::uint16_t>::max()) return static_cast<std::uint16_t>(count);
  throw std::invalid_argument(std::string("the street is too long: more than 65535 ") + what);
}

}  // namespace

World::World() {
  add_ground(*this, standard_);
  add_buildings(*this, standard_);
  add_gardens(*this, standard_);
  add_furniture(*this, standard_);
  add_vehicles(*this, standard_);
  // Behind all others, so that these keep their numbers.
  add_rough(*this, standard_);
  const StandardMaterials& m = standard_;
  vehicles_[kCar] = {m.car_glass, m.tyre, m.rim, m.car_interior, m.car_trim, m.headlight, m.tail_light, m.plate};
  for (const SurfaceClass label : {kTruck, kBus, kOtherVehicle, kMotorcycle, kMotorcyclist, kBicyclist}) {
    vehicles_[label] = add_vehicle_materials(*this, label);
  }
}

MaterialId World::add_paint(SurfaceClass label, Random& random) {
  const std::array<Color, 8> colors = {{{.08F, .08F, .09F},
                                        {.30F, .31F, .33F},
                                        {.55F, .57F, .58F},
                                        {.93F, .93F, .92F},
                                        {.13F, .20F, .42F},
                                        {.55F, .08F, .09F},
                                        {.20F, .30F, .24F},
                                        {.75F, .70F, .25F}}};
  const std::array<float, 8> reflectances = {.03F, .15F, .35F, .65F, .25F, .40F, .25F, .50F};
  const std::size_t color = random.index(colors.size());
  return add_material({label, colors[color], reflectances[color], 0, static_cast<float>(random.uniform(0.3, 0.55))});
}

const VehicleMaterials& World::vehicle(SurfaceClass label) const {
  const auto found = vehicles_.find(label);
  return found == vehicles_.end() ? vehicles_.at(kCar) : found->second;
}

MaterialId World::add_material(const Material& material) {
  const MaterialId id = next_number(materials_.size(), "materials");
  materials_.push_back(material);
  return id;
}

Brush World::add_object(Mesh& mesh, SceneObject object, const Eigen::Isometry3d& scene_from_object,
                        MaterialId material) {
  object.position = scene_from_object.translation();
  return {&mesh, scene_from_object, material, add_object(std::move(object))};
}

ObjectId World::add_object(SceneObject object) {
  const ObjectId id = next_number(objects_.size(), "objects");
  objects_.push_back(std::move(object));
  return id;
}

}  // namespace vdbmap::simulator
