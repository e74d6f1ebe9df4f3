// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/lot_scenery.h"

#include <algorithm>
#include <numbers>

#include "tools/simulator/furniture.h"
#include "tools/simulator/house.h"
#include "tools/simulator/things/shrub.h"

namespace vdbmap::simulator {
namespace {

constexpr double kGateGap = 1.3;  // [m] that a garden's border leaves open before the door

// Draws one lot.
class LotPainter {
 public:
  LotPainter(World& world, Mesh& mesh, const StreetLayout& layout, const SideLayout& side, const Lot& lot,
             std::vector<Tree>& trees)
      : world_(world),
        mesh_(mesh),
        layout_(layout),
        side_(side),
        lot_(lot),
        trees_(trees),
        random_(hash(lot.seed, 7)),
        lot_frame_(layout.place_lot(side, lot, side.facade_offset())),
        border_frame_(layout.place_lot(side, lot, side.pavement_offset() + 0.05)) {}

  void draw() {
    if (lot_.kind == LotKind::kHouse) draw_house();
    if (lot_.kind == LotKind::kGap) draw_gap();
    if (lot_.kind == LotKind::kDriveway) draw_driveway();
    if (lot_.kind == LotKind::kSideStreet) draw_side_street();
    if (lot_.kind == LotKind::kPark) draw_park();
    if (lot_.kind == LotKind::kCarPark) draw_car_park();
    if (lot_.kind == LotKind::kHall) draw_hall();
    if (lot_.kind == LotKind::kOpen) draw_open();
  }

 private:
  const StandardMaterials& materials() const { return world_.standard(); }

  Brush object(const char* kind, const Eigen::Isometry3d& frame, MaterialId material) {
    return world_.add_object(mesh_, {kind, {}}, frame, material);
  }

  static Eigen::Isometry3d moved(const Eigen::Isometry3d& frame, double x, double y, double yaw = 0) {
    return frame * Eigen::Translation3d(x, y, 0) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
  }

  void add_tree(const Eigen::Isometry3d& frame, double radius) { add_tree(make_tree(frame, radius, random_)); }

  void add_tree(Tree tree) {
    if (!layout_.is_ideal) roughen(tree, random_);
    tree.leaves = materials().leaves;
    tree.object = world_.add_object({"tree", tree.scene_from_foot.translation()});
    add_wood(mesh_, tree, materials());
    trees_.push_back(tree);
  }

  void draw_house() {
    const HouseType& type = side_.house_types[lot_.house_type];
    add_house(world_, mesh_, {moved(lot_frame_, 0, type.stand_back), type, side_.housing, lot_.seed});
    if (side_.garden_depth > 0) draw_front_garden(type);
    if (random_.chance(0.45)) {
      add_tree(moved(lot_frame_, random_.uniform(0, type.width), type.depth + random_.uniform(4, 12)),
               random_.uniform(2, 3.5));
    }
  }

  void draw_front_garden(const HouseType& type) {
    const double door = type.width * (type.door_axis + 0.5) / type.num_axes;
    draw_border(0, door - kGateGap / 2);
    draw_border(door + kGateGap / 2, type.width);
    const std::size_t num_bushes = 3 + random_.index(6);
    for (std::size_t i = 0; i < num_bushes; ++i) {
      const double x = random_.uniform(0.6, type.width - 0.6);
      const double y = random_.uniform(1.0, side_.garden_depth - 0.6);
      if (std::abs(x - door) < 1.0) continue;
      add_garden_bush(object("bush", moved(border_frame_, x, y), materials().leaves), random_.uniform(0.4, 1.1));
    }
    const double x = door > type.width / 2 ? 0.2 * type.width : 0.8 * type.width;
    const Eigen::Isometry3d place = moved(border_frame_, x, side_.garden_depth * 0.5);
    if (random_.chance(0.55)) {
      add_tree(make_low_tree(place, random_.uniform(1.1, 1.9), random_));
    } else if (random_.chance(0.2)) {
      add_tree(place, random_.uniform(1.2, 2));
    }
  }

  void add_garden_bush(const Brush& leaves, double radius) {
    if (layout_.is_ideal) return add_bush(leaves, radius, random_);
    add_rough_bush(leaves, materials().twigs, radius, random_);
  }

  void add_garden_hedge(const Brush& leaves, const Eigen::Vector3d& size) {
    if (layout_.is_ideal) return add_hedge(leaves, size, random_);
    add_rough_hedge(leaves, materials().twigs, size, random_);
  }

  // Hedge, fence or wall between pavement and garden; neighbours of one type have much the same.
  void draw_border(double from, double to) {
    if (to - from < 0.4) return;
    const double choice = random_.uniform(0, 1) * 0.5 + 0.125 * static_cast<double>(lot_.house_type);
    const Eigen::Isometry3d frame = moved(border_frame_, from, 0);
    if (choice < 0.58) {
      Eigen::Vector3d size(to - from, random_.uniform(0.5, 0.9), random_.uniform(0.9, 2.0));
      if (!layout_.is_ideal && random_.chance(0.5)) size.z() = random_.uniform(0.4, 1.1);
      add_garden_hedge(object("hedge", frame, materials().hedge), size);
    } else if (choice < 0.72) {
      const bool is_wood = random_.chance(0.5);
      add_fence(object("fence", frame, is_wood ? materials().wood : materials().metal_fence), to - from,
                random_.uniform(0.8, 1.2), is_wood ? 0.11 : 0.13);
    } else if (choice < 0.8) {
      add_box(object("wall", frame, materials().brick_wall), {0, 0, -0.3},
              {to - from, 0.24, random_.uniform(0.4, 0.9)});
    }
  }

  // A fence between the houses, and what grows behind it.
  void draw_gap() {
    const double width = lot_.along.length();
    if (side_.garden_depth > 0) draw_border(0, width);
    add_fence(object("fence", moved(lot_frame_, 0, 1), materials().wood), width, 1.8, 0.11);
    add_tree(moved(lot_frame_, width / 2, random_.uniform(14, 22)), random_.uniform(2, 3.5));
  }

  void draw_driveway() {
    const double width = lot_.along.length();
    if (side_.housing == Housing::kBlock) {
      add_fence(object("gate", lot_frame_, materials().metal_fence), width, 2.1, 0.13);
    } else if (random_.chance(0.75)) {
      const MaterialId walls = random_.chance(0.5) ? materials().stone : materials().door;
      const Eigen::Vector3d size(width - 0.5, random_.uniform(4, 6), random_.uniform(2.2, 2.7));
      const Brush shed = object("shed", moved(lot_frame_, 0.25, random_.uniform(2, 7)), walls);
      add_shed(shed, size, materials().window_frame, materials().dark_roof);
    }
    add_tree(moved(lot_frame_, width / 2, random_.uniform(16, 26)), random_.uniform(2.5, 3.5));
  }

  // Trees and bushes on grass, a hedge here and there along the pavement, benches.
  void draw_park() {
    const double width = lot_.along.length(), depth = std::min(40.0, layout_.scenery_depth - side_.facade_offset() - 2);
    for (double x = 2; x < width; x += random_.uniform(5, 9)) {
      add_tree(moved(border_frame_, x, random_.uniform(2, 6)), random_.uniform(2, 3.6));
      add_tree(moved(border_frame_, x, random_.uniform(10, std::max(11.0, depth))), random_.uniform(2, 4));
    }
    for (int i = 0; i < static_cast<int>(width / 3); ++i) {
      const Eigen::Isometry3d place =
          moved(border_frame_, random_.uniform(1, width - 1), random_.uniform(1, depth / 2));
      add_garden_bush(object("bush", place, materials().leaves), random_.uniform(0.4, 1.6));
    }
    if (random_.chance(0.4)) draw_border(0, width);
  }

  // A hedge or nothing towards the pavement, and lamps between the rows; its cars are those of Parking.
  void draw_car_park() {
    const double width = lot_.along.length();
    if (random_.chance(0.5)) draw_border(0, width / 2 - 3);
    if (random_.chance(0.5)) draw_border(width / 2 + 3, width);
    for (double x = 6; x < width; x += 15) {
      add_lamp(object("lamp", moved(lot_frame_, x, 9.2), materials().steel), materials());
    }
    add_fence(object("fence", moved(lot_frame_, 0, 24), materials().metal_fence), width, 1.8, 0.13);
  }

  // A long wall, smooth or of panels, that nothing but a gate interrupts.
  void draw_hall() {
    const double width = lot_.along.length() - 1, depth = random_.uniform(12, 22), height = random_.uniform(4.5, 9);
    const MaterialId skin = random_.chance(0.5) ? materials().plaster : materials().stone;
    const Brush wall = object("hall", moved(lot_frame_, 0.5, 0.3), skin);
    add_box(wall, {0, 0, -0.6}, {width, depth, height});
    if (random_.chance(0.6)) {
      for (double x = 0; x < width; x += 2.5) add_box(wall, {x, -0.08, -0.6}, {x + 0.15, 0, height});
    }
    const double gate = random_.uniform(0.2, 0.7) * width;
    add_box(wall.with(materials().door), {gate, -0.03, 0}, {gate + 3.5, 0, 3.6});
  }

  // Grass and a view; what is seen in it is far.
  void draw_open() {
    const double width = lot_.along.length(), depth = layout_.scenery_depth - side_.facade_offset();
    if (random_.chance(0.5)) {
      add_fence(object("fence", border_frame_, materials().wood), width, random_.uniform(0.9, 1.3), 0.4);
    }
    for (double x = -15; x < width + 15; x += random_.uniform(6, 14)) {
      add_tree(moved(lot_frame_, x, random_.uniform(0.7, 0.95) * depth), random_.uniform(2.5, 4));
    }
  }

  // Houses on each side of it, and a tree where it ends.
  void draw_side_street() {
    const double width = lot_.along.length();
    const HouseType& type = side_.house_types.front();
    const int num_houses = layout_.is_ideal ? 3 : std::max(3, static_cast<int>(95 / type.width));
    double y = 13;
    for (int i = 0; i < num_houses; ++i, y += type.width) {
      const Eigen::Isometry3d right = moved(lot_frame_, width + 1.8, y + type.width, -std::numbers::pi / 2);
      const Eigen::Isometry3d left = moved(lot_frame_, -1.8, y, std::numbers::pi / 2);
      add_house(world_, mesh_, {right, type, side_.housing, random_.seed()});
      add_house(world_, mesh_, {left, type, side_.housing, random_.seed()});
    }
    add_tree(moved(lot_frame_, width / 2, y + 6), 3.5);
  }

  World& world_;
  Mesh& mesh_;
  const StreetLayout& layout_;
  const SideLayout& side_;
  const Lot& lot_;
  std::vector<Tree>& trees_;
  Random random_;
  Eigen::Isometry3d lot_frame_;
  Eigen::Isometry3d border_frame_;
};

}  // namespace

void add_lot(World& world, Mesh& mesh, const StreetLayout& layout, const SideLayout& side, const Lot& lot,
             std::vector<Tree>& trees) {
  LotPainter(world, mesh, layout, side, lot, trees).draw();
}

}  // namespace vdbmap::simulator
