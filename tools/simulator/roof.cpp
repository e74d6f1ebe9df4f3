// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/roof.h"

namespace vdbmap::simulator {
namespace {

// Lengths [m].
constexpr double kOverhang = 0.4;
constexpr double kParapet = 0.5;
constexpr double kPipeRadius = 0.05;

void add_flat_roof(const Brush& house, const HouseType& type, double eaves, MaterialId tiles) {
  add_quad(house.with(tiles), {0, 0, eaves}, {type.width, 0, eaves}, {type.width, type.depth, eaves},
           {0, type.depth, eaves});
  add_box(house, {0, 0, eaves}, {type.width, 0.25, eaves + kParapet});
  add_box(house, {0, type.depth - 0.25, eaves}, {type.width, type.depth, eaves + kParapet});
}

// Two slopes whose ridge runs along the street.
void add_roof_along(const Brush& house, const HouseType& type, double eaves, MaterialId tiles) {
  const double middle = type.depth / 2;
  const double ridge = eaves + type.roof_slope * middle;
  const double low = eaves - type.roof_slope * kOverhang;
  const Brush roof = house.with(tiles);
  add_quad(roof, {0, -kOverhang, low}, {type.width, -kOverhang, low}, {type.width, middle, ridge}, {0, middle, ridge});
  add_quad(roof, {0, type.depth + kOverhang, low}, {type.width, type.depth + kOverhang, low},
           {type.width, middle, ridge}, {0, middle, ridge});
  for (const double x : {0.0, type.width}) {
    add_triangle(house, {x, 0, eaves}, {x, type.depth, eaves}, {x, middle, ridge});
  }
  add_tube(house.with(tiles), {{0, -kOverhang, low}, {type.width, -kOverhang, low}, 0.07, 0.07, 6});
}

// Two slopes whose gable faces the street.
void add_roof_across(const Brush& house, const HouseType& type, double eaves, MaterialId tiles) {
  const double middle = type.width / 2;
  const double ridge = eaves + type.roof_slope * middle;
  const double low = eaves - type.roof_slope * kOverhang;
  const double back = type.depth + kOverhang;
  const Brush roof = house.with(tiles);
  add_quad(roof, {-kOverhang, -kOverhang, low}, {-kOverhang, back, low}, {middle, back, ridge},
           {middle, -kOverhang, ridge});
  add_quad(roof, {type.width + kOverhang, -kOverhang, low}, {type.width + kOverhang, back, low}, {middle, back, ridge},
           {middle, -kOverhang, ridge});
  for (const double y : {0.0, type.depth}) {
    add_triangle(house, {0, y, eaves}, {type.width, y, eaves}, {middle, y, ridge});
  }
}

void add_dormer(const Brush& house, double x, double eaves, MaterialId tiles, const StandardMaterials& materials) {
  const double front = 0.7;
  add_box(house, {x - 0.75, front, eaves + 0.3}, {x + 0.75, 3, eaves + 2.0});
  add_box(house.with(tiles), {x - 0.9, front - 0.2, eaves + 2.0}, {x + 0.9, 3.2, eaves + 2.12});
  add_box(house.with(materials.window_frame), {x - 0.6, front - 0.02, eaves + 0.8}, {x + 0.6, front, eaves + 1.9});
  add_box(house.with(materials.interior), {x - 0.52, front - 0.03, eaves + 0.88},
          {x + 0.52, front - 0.02, eaves + 1.82});
}

}  // namespace

void add_roof(const Brush& house, const HouseType& type, double eaves, MaterialId tiles,
              const StandardMaterials& materials) {
  if (type.roof == RoofKind::kFlat) add_flat_roof(house, type, eaves, tiles);
  if (type.roof == RoofKind::kAlong) add_roof_along(house, type, eaves, tiles);
  if (type.roof == RoofKind::kAcross) add_roof_across(house, type, eaves, tiles);
  if (type.has_dormers) {
    for (const double share : {0.28, 0.72}) add_dormer(house, share * type.width, eaves, tiles, materials);
  }
  const double ridge = type.roof_slope * type.depth / 2;
  add_box(house.with(materials.stone), {0.6, type.depth * 0.55, eaves},
          {1.1, type.depth * 0.55 + 0.6, eaves + (type.roof == RoofKind::kFlat ? 1.2 : ridge + 0.6)});
  const Eigen::Vector3d foot(0.15, -kPipeRadius - 0.02, 0);
  add_tube(house.with(materials.gutter), {foot, foot + Eigen::Vector3d(0, 0, eaves), kPipeRadius, kPipeRadius, 8});
}

}  // namespace vdbmap::simulator
