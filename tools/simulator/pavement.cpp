// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/pavement.h"

#include <numbers>

#include "tools/simulator/furniture.h"
#include "tools/simulator/things/plants.h"
#include "tools/simulator/things/shrub.h"

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

  // Shrubs and ground cover on the whole of an island, and now and then a tree.
  void draw_planted_island(const Interval& island) {
    const double middle = side_.kerb_offset() - side_.parking_width / 2;
    const Eigen::Isometry3d place = layout_.place_on_side(side_, island.middle(), middle);
    draw_planting({object("planting", place), world_, random_, island.length(), side_.parking_width - 0.2, false});
    if (random_.chance(0.5)) add_tree(place);
  }

  // A tree between parked cars, with shrubs at its foot.
  void draw_islands() {
    for (const Interval& island : side_.islands) {
      if (!layout_.is_ideal && random_.chance(0.6)) {
        draw_planted_island(island);
        continue;
      }
      const double distance = side_.kerb_offset() - 1.0;
      add_tree(layout_.place_on_side(side_, island.middle(), distance));
      for (const double aside : {-0.55, 0.55}) {
        const Eigen::Isometry3d foot = layout_.place_on_side(side_, island.middle() + aside, distance);
        const Brush leaves = object("shrub", foot).with(world_.standard().leaves);
        if (layout_.is_ideal) {
          add_bush(leaves, random_.uniform(0.4, 0.7), random_);
        } else {
          add_rough_bush(leaves, world_.standard().twigs, random_.uniform(0.35, 0.6), random_);
        }
      }
    }
  }

  void add_tree(const Eigen::Isometry3d& foot) {
    Tree tree = make_tree(foot, random_.uniform(1.7, 2.6), random_);
    if (!layout_.is_ideal) roughen(tree, random_);
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

}  // namespace

void add_pavement(World& world, Mesh& mesh, const StreetLayout& layout, std::vector<Tree>& trees, Random& random) {
  for (const SideLayout& side : layout.sides) {
    PavementPainter(world, mesh, layout, side, trees, random).draw();
  }
}

}  // namespace vdbmap::simulator
