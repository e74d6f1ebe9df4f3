// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/house.h"

#include <array>
#include <numbers>

#include "tools/simulator/facade.h"
#include "tools/simulator/roof.h"

namespace vdbmap::simulator {
namespace {

// Lengths [m].
constexpr double kFoundation = 0.6;  // how far walls reach into the ground
constexpr double kDoorWidth = 1.1;
constexpr double kDoorHeight = 2.5;  // the window above it included
constexpr double kDoorRecess = 0.3;
constexpr double kBayDepth = 0.7;
constexpr double kBalconyDepth = 1.2;

Material wall_material(bool is_brick, Random& random) {
  const std::array<Eigen::Vector3f, 4> bricks = {
      {{.55F, .30F, .23F}, {.62F, .40F, .30F}, {.45F, .25F, .22F}, {.70F, .58F, .42F}}};
  const std::array<Eigen::Vector3f, 7> plasters = {{{.86F, .83F, .76F},
                                                    {.90F, .89F, .86F},
                                                    {.84F, .74F, .56F},
                                                    {.74F, .78F, .76F},
                                                    {.80F, .66F, .58F},
                                                    {.70F, .68F, .64F},
                                                    {.88F, .82F, .62F}}};
  Material material{SurfaceClass::kBuilding, is_brick ? bricks[random.index(4)] : plasters[random.index(7)]};
  material.reflectance = static_cast<float>(is_brick ? random.uniform(0.3, 0.42) : random.uniform(0.4, 0.65));
  material.texture = is_brick ? Texture::kBrick : Texture::kPlaster;
  return material;
}

// A house being drawn: its type, its pieces and the brush for its walls.
class House {
 public:
  House(const Brush& walls, const HouseType& type, Housing housing, const StandardMaterials& materials, Random& random)
      : walls_(walls), type_(type), is_block_(housing == Housing::kBlock), materials_(materials), random_(random) {}

  void draw() {
    draw_front();
    draw_sides();
    for (int storey = 0; storey <= type_.num_storeys; ++storey) draw_floor(storey);
    if (type_.bay_axis >= 0) draw_bay();
    add_roof(walls_, type_, eaves(), random_.chance(0.7) ? materials_.roof_tiles : materials_.dark_roof, materials_);
  }

 private:
  double floor(int storey) const { return type_.plinth + storey * type_.storey_height; }
  double eaves() const { return floor(type_.num_storeys) + 0.3; }
  double axis(int index) const { return type_.width * (index + 0.5) / type_.num_axes; }
  // Over a pavement a bay window begins on the first floor.
  bool is_in_bay(int storey, int index) const { return index == type_.bay_axis && storey >= (is_block_ ? 1 : 0); }
  bool has_balcony(int storey, int index) const { return index == type_.balcony_axis && storey > 0; }

  WallPatch window(int storey, double center, bool is_tall) const {
    const double bottom = floor(storey) + (is_tall ? 0.05 : type_.sill);
    const double top = floor(storey) + type_.sill + type_.window_height;
    return {center - type_.window_width / 2, center + type_.window_width / 2, bottom, top};
  }

  WallPatch door() const {
    const double center = axis(type_.door_axis);
    return {center - kDoorWidth / 2, center + kDoorWidth / 2, type_.plinth, type_.plinth + kDoorHeight};
  }

  void draw_front() {
    std::vector<WallPatch> holes = {door()};
    add_door(walls_, door(), kDoorRecess, materials_);
    for (int storey = 0; storey < type_.num_storeys; ++storey) {
      for (int index = 0; index < type_.num_axes; ++index) {
        if (is_in_bay(storey, index) || (storey == 0 && index == type_.door_axis)) continue;
        holes.push_back(draw_window(storey, index));
      }
    }
    add_wall(walls_, {0, type_.width, -kFoundation, eaves()}, holes);
    add_box(walls_.with(materials_.stone), {0, -0.04, -kFoundation},
            {door().left, 0, type_.plinth - 0.1});  // the plinth stands out a little
    add_box(walls_.with(materials_.stone), {door().right, -0.04, -kFoundation}, {type_.width, 0, type_.plinth - 0.1});
  }

  WallPatch draw_window(int storey, int index) {
    const WallPatch hole = window(storey, axis(index), has_balcony(storey, index));
    add_window(walls_, hole, type_.recess, materials_, random_);
    if (has_balcony(storey, index)) {
      add_balcony(walls_, {hole.left - 0.5, hole.right + 0.5, hole.bottom, hole.top}, kBalconyDepth, materials_);
    }
    return hole;
  }

  // The wall towards x = 0 and its opposite, each in a frame of its own, and the back.
  void draw_sides() {
    using std::numbers::pi;
    const WallPatch side = {0, type_.depth, -kFoundation, eaves()};
    for (const Brush& wall : {walls_.at({0, type_.depth, 0}, -pi / 2), walls_.at({type_.width, 0, 0}, pi / 2)}) {
      std::vector<WallPatch> holes;
      for (int storey = 0; storey < type_.num_storeys; ++storey) {
        if (!random_.chance(0.5)) continue;
        holes.push_back(window(storey, random_.uniform(0.3, 0.7) * type_.depth, false));
        add_window(wall, holes.back(), type_.recess, materials_, random_);
      }
      add_wall(wall, side, holes);
    }
    add_wall(walls_.at({0, type_.depth, 0}), {0, type_.width, -kFoundation, eaves()}, {});
  }

  // Ceilings are seen through windows from below.
  void draw_floor(int storey) {
    const double z = floor(storey) - 0.1;
    add_quad(walls_.with(materials_.interior), {0.3, 0.35, z}, {type_.width - 0.3, 0.35, z},
             {type_.width - 0.3, type_.depth - 0.3, z}, {0.3, type_.depth - 0.3, z});
  }

  void draw_bay() {
    const double half = type_.window_width / 2 + 0.35;
    const double x = axis(type_.bay_axis);
    const double bottom = is_block_ ? floor(1) - 0.2 : -kFoundation;
    const double top = floor(type_.num_storeys) - 0.1;
    if (bottom >= top) return;
    const WallPatch front = {x - half, x + half, bottom, top};
    const Brush bay = walls_.at({0, -kBayDepth, 0});
    std::vector<WallPatch> holes;
    for (int storey = is_block_ ? 1 : 0; storey < type_.num_storeys; ++storey) {
      holes.push_back(window(storey, x, false));
      add_window(bay, holes.back(), type_.recess, materials_, random_);
    }
    add_wall(bay, front, holes);
    close_bay(front);
  }

  void close_bay(const WallPatch& front) {
    const std::array<Eigen::Vector3d, 4> outside = {{{front.left, -kBayDepth, front.bottom},
                                                     {front.right, -kBayDepth, front.bottom},
                                                     {front.right, -kBayDepth, front.top},
                                                     {front.left, -kBayDepth, front.top}}};
    std::array<Eigen::Vector3d, 4> inside = outside;
    for (Eigen::Vector3d& corner : inside) corner.y() = 0;
    add_loft(walls_, outside, inside, true);
  }

  Brush walls_;
  const HouseType& type_;
  bool is_block_;
  const StandardMaterials& materials_;
  Random& random_;
};

}  // namespace

void add_house(World& world, Mesh& mesh, const HouseSite& site) {
  Random random(site.seed);
  const MaterialId material = world.add_material(wall_material(site.type.has_brick, random));
  const Brush walls = world.add_object(mesh, {"house", {}}, site.scene_from_house, material);
  House(walls, site.type, site.housing, world.standard(), random).draw();
}

}  // namespace vdbmap::simulator
