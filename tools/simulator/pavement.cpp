// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/pavement.h"

#include <numbers>

#include "tools/simulator/furniture.h"

namespace vdbmap::simulator {
namespace {

constexpr double kLampDistance = 28;  // [m]
constexpr double kClearance = 1.4;    // [m] between two things, and to driveways

// Where on a pavement posts stand: at the kerb, unless cars do.
double post_distance(const SideLayout& side) {
  const bool has_cars = side.parking == ParkingKind::kHalfOnPavement || side.parking == ParkingKind::kOnPavement;
  return has_cars ? side.pavement_offset() - 0.3 : side.kerb_offset() + 0.55;
}

// One side's pavement, with a note of what is taken.
class PavementPainter {
 public:
  PavementPainter(World& world, Mesh& mesh, const StreetLayout& layout, const SideLayout& side,
                  std::vector<Tree>& trees, Random& random)
      : world_(world), mesh_(mesh), layout_(layout), side_(side), trees_(trees), random_(random) {}

  void draw() {
    draw_corners();
    draw_lamps();
    draw_signs();
    draw_islands();
    if (side_.islands.empty()) draw_trees();
  }

 private:
  // Takes a place for itself, if it is free.
  bool take(double station) {
    const Interval place = {station - kClearance / 2, station + kClearance / 2};
    if (!side_.is_plain(place, kClearance / 2)) return false;
    for (const double other : taken_) {
      if (std::abs(other - station) < kClearance) return false;
    }
    taken_.push_back(station);
    return true;
  }

  Eigen::Isometry3d post(double station) const { return layout_.place_on_side(side_, station, post_distance(side_)); }

  Brush object(const char* kind, const Eigen::Isometry3d& frame) {
    return world_.add_object(mesh_, {kind, {}}, frame, world_.standard().steel);
  }

  static Eigen::Isometry3d turned(const Eigen::Isometry3d& frame, double yaw) {
    return frame * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
  }

  // Signs and bollards where a side street comes in.
  void draw_corners() {
    for (const Interval& street : side_.stretches(LotKind::kSideStreet)) {
      const double before = street.begin - 2.2;
      const double after = street.end + 2.2;
      taken_.insert(taken_.end(), {before, after});
      add_sign(object("sign", turned(post(before), std::numbers::pi / 2)), SignKind::kGiveWay, world_.standard());
      add_sign(object("sign", post(after)), SignKind::kStreetName, world_.standard());
      for (int i = 1; i <= 3; ++i) draw_bollard(before - 1.5 * i);
      for (int i = 1; i <= 3; ++i) draw_bollard(after + 1.5 * i);
    }
  }

  void draw_bollard(double station) {
    if (take(station)) add_bollard(object("bollard", post(station)), world_.standard());
  }

  void draw_lamps() {
    const double phase = side_.sign > 0 ? 0.0 : kLampDistance / 2;
    for (double station = layout_.begin() + phase; station < layout_.end(); station += kLampDistance) {
      const double place = station + random_.uniform(-1.5, 1.5);
      if (take(place)) add_lamp(object("lamp", turned(post(place), std::numbers::pi)), world_.standard());
    }
  }

  void draw_signs() {
    for (double station = 6; station < layout_.length; station += random_.uniform(22, 40)) {
      const SignKind kind = random_.chance(0.5) ? SignKind::kParking : SignKind::kNoStopping;
      if (take(station)) add_sign(object("sign", post(station)), kind, world_.standard());
    }
  }

  void draw_trees() {
    const double spacing = random_.uniform(11, 19);
    for (double station = layout_.begin() + random_.uniform(0, 8); station < layout_.end(); station += spacing) {
      const double place = station + random_.uniform(-1, 1);
      if (random_.chance(0.85) && take(place)) add_tree(post(place));
    }
  }

  // A tree between parked cars, with shrubs at its foot.
  void draw_islands() {
    for (const Interval& island : side_.islands) {
      const double distance = side_.kerb_offset() - 1.0;
      add_tree(layout_.place_on_side(side_, island.middle(), distance));
      for (const double aside : {-0.55, 0.55}) {
        const Eigen::Isometry3d foot = layout_.place_on_side(side_, island.middle() + aside, distance);
        add_bush(object("shrub", foot).with(world_.standard().leaves), random_.uniform(0.4, 0.7), random_);
      }
    }
  }

  void add_tree(const Eigen::Isometry3d& foot) {
    Tree tree = make_tree(foot, random_.uniform(1.7, 2.6), random_);
    tree.leaves = world_.standard().leaves;
    tree.object = world_.add_object({"tree", foot.translation()});
    add_wood(mesh_, tree, world_.standard());
    trees_.push_back(tree);
  }

  World& world_;
  Mesh& mesh_;
  const StreetLayout& layout_;
  const SideLayout& side_;
  std::vector<Tree>& trees_;
  Random& random_;
  std::vector<double> taken_;  // stations [m]
};

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

void add_pavement(World& world, Mesh& mesh, const StreetLayout& layout, std::vector<Tree>& trees, Random& random) {
  for (const SideLayout& side : layout.sides) {
    PavementPainter(world, mesh, layout, side, trees, random).draw();
  }
}

void add_passers_by(World& world, Mesh& mesh, const StreetLayout& layout, int epoch, std::uint64_t seed) {
  Random random(hash(hash(seed, 21), static_cast<std::uint64_t>(epoch)));
  for (const SideLayout& side : layout.sides) {
    draw_people(world, mesh, layout, side, epoch, random);
    draw_bicycles(world, mesh, layout, side, epoch, random);
    draw_bins(world, mesh, layout, side, epoch, seed);
  }
}

}  // namespace vdbmap::simulator
