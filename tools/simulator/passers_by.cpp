// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/passers_by.h"

#include <numbers>

#include "tools/simulator/furniture.h"

namespace vdbmap::simulator {
namespace {

Eigen::Vector3f random_color(Random& random) {
  return {static_cast<float>(random.uniform(0.1, 0.8)), static_cast<float>(random.uniform(0.1, 0.7)),
          static_cast<float>(random.uniform(0.1, 0.8))};
}

MaterialId cloth(World& world, Random& random) {
  return world.add_material({SurfaceClass::kPerson, random_color(random), 0.45F});
}

void draw_people(World& world, Mesh& mesh, const StreetLayout& layout, const SideLayout& side, int epoch,
                 Random& random) {
  const MaterialId skin = world.add_material({SurfaceClass::kPerson, {.78F, .60F, .50F}, .5F});
  const int count = 1 + static_cast<int>(layout.length / 40);
  for (int i = 0; i < count; ++i) {
    const double station = random.uniform(0, layout.length);
    const bool crosses = random.chance(0.1);
    const double distance = crosses ? 0.6 * side.lane_width : side.pavement_offset() - random.uniform(0.6, 1.1);
    const double yaw = crosses ? std::numbers::pi / 2 : (random.chance(0.5) ? 0 : std::numbers::pi);
    const Eigen::Isometry3d frame = layout.place(station, side.sign * distance, yaw + random.normal(0, 0.15));
    const Clothes clothes = {skin, cloth(world, random), cloth(world, random)};
    const Brush brush = world.add_object(mesh, {"person", {}, epoch}, frame, skin);
    add_person(brush, random.normal(1.72, 0.08), random.uniform(0, 0.5), clothes);
  }
}

void draw_bicycles(World& world, Mesh& mesh, const StreetLayout& layout, const SideLayout& side, int epoch,
                   Random& random) {
  const MaterialId tyre = world.add_material({SurfaceClass::kBicycle, {.1F, .1F, .1F}, .1F});
  const int count = 1 + static_cast<int>(layout.length / 30);
  for (int i = 0; i < count; ++i) {
    const double station = random.uniform(0, layout.length);
    if (!side.is_plain({station - 1, station + 1}, 0.2)) continue;
    const Eigen::Isometry3d wall = layout.place_on_side(side, station, side.pavement_offset() - 0.3);
    const double yaw = random.normal(0, 0.05) + (random.chance(0.5) ? std::numbers::pi : 0);
    // Leaning a few degrees, as on its stand.
    const Eigen::Isometry3d frame(wall * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(random.normal(0, 0.12), Eigen::Vector3d::UnitX()));
    const MaterialId paint = world.add_material({SurfaceClass::kBicycle, random_color(random), 0.4F, 0, 0.2F});
    add_bicycle(world.add_object(mesh, {"bicycle", {}, epoch}, frame, paint), tyre);
  }
}

MaterialId bin_color(World& world, Random& random) {
  const Eigen::Vector3f colors[] = {{.25F, .26F, .27F}, {.12F, .25F, .50F}, {.40F, .28F, .16F}, {.78F, .65F, .10F}};
  return world.add_material({SurfaceClass::kOtherObject, colors[random.index(4)], 0.3F, 0, 0.1F});
}

// The same bins stand before the same houses, but not twice in the same place.
void draw_bins(World& world, Mesh& mesh, const StreetLayout& layout, const SideLayout& side, int epoch,
               std::uint64_t seed) {
  for (const Lot& lot : side.lots) {
    Random of_house(hash(lot.seed, 11));
    Random of_epoch(hash(hash(lot.seed, seed), static_cast<std::uint64_t>(epoch)));
    if (lot.kind != LotKind::kHouse || !of_house.chance(0.4)) continue;
    const std::size_t count = 1 + of_house.index(3);
    const double x = of_house.uniform(0.6, lot.along.length() - 0.6);
    const MaterialId color = bin_color(world, of_house);
    for (std::size_t i = 0; i < count; ++i) {
      const bool is_large = of_house.chance(0.5);
      if (of_epoch.chance(0.15)) continue;
      const double station = lot.along.begin + x + 0.7 * static_cast<double>(i) + of_epoch.normal(0, 0.12);
      Eigen::Isometry3d frame =
          layout.place_on_side(side, station, side.pavement_offset() - 0.45 + of_epoch.normal(0, 0.06));
      frame.rotate(Eigen::AngleAxisd(std::numbers::pi / 2 + of_epoch.normal(0, 0.15), Eigen::Vector3d::UnitZ()));
      add_bin(world.add_object(mesh, {"bin", {}, epoch}, frame, color), is_large);
    }
  }
}

}  // namespace

void add_passers_by(World& world, Mesh& mesh, const StreetLayout& layout, int epoch, std::uint64_t seed) {
  Random random(hash(hash(seed, 21), static_cast<std::uint64_t>(epoch)));
  for (const SideLayout& side : layout.sides) {
    draw_people(world, mesh, layout, side, epoch, random);
    draw_bicycles(world, mesh, layout, side, epoch, random);
    draw_bins(world, mesh, layout, side, epoch, seed);
  }
}

}  // namespace vdbmap::simulator
