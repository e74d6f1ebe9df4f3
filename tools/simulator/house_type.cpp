// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/house_type.h"

#include <algorithm>
#include <cmath>

namespace vdbmap::simulator {
namespace {

double rounded(double value, double step) { return std::round(value / step) * step; }

double choose_width(Housing housing, Random& random) {
  if (housing == Housing::kTerraced) return rounded(random.uniform(5.6, 7.4), 0.1);
  if (housing == Housing::kBlock) return rounded(random.uniform(11, 16), 0.1);
  return rounded(random.uniform(8.5, 12), 0.1);
}

RoofKind choose_roof(Housing housing, Random& random) {
  if (housing == Housing::kDetached) return random.chance(0.5) ? RoofKind::kAcross : RoofKind::kAlong;
  return housing == Housing::kBlock && random.chance(0.25) ? RoofKind::kFlat : RoofKind::kAlong;
}

int choose_storeys(Housing housing, Random& random) {
  if (housing == Housing::kBlock) return 3 + static_cast<int>(random.index(3));
  return housing == Housing::kTerraced ? 2 + static_cast<int>(random.index(2)) : 1 + static_cast<int>(random.index(2));
}

int choose_other_axis(const HouseType& type, int taken, Random& random) {
  for (;;) {
    const int axis = static_cast<int>(random.index(static_cast<std::size_t>(type.num_axes)));
    if (axis != taken) return axis;
  }
}

// Bay windows and balconies stand above the door's reach, never on the door's axis.
void add_extensions(HouseType& type, Housing housing, Random& random) {
  type.bay_axis = random.chance(0.45) ? choose_other_axis(type, type.door_axis, random) : -1;
  const bool has_balcony = type.num_storeys > 1 && random.chance(housing == Housing::kBlock ? 0.6 : 0.3);
  type.balcony_axis = has_balcony ? choose_other_axis(type, type.door_axis, random) : -1;
  if (type.balcony_axis == type.bay_axis) type.balcony_axis = -1;
}

HouseType make_type(Housing housing, Random& random) {
  const bool is_block = housing == Housing::kBlock;
  HouseType type;
  type.width = choose_width(housing, random);
  type.depth = rounded(random.uniform(9, 12), 0.1);
  type.num_storeys = choose_storeys(housing, random);
  type.storey_height = rounded(is_block ? random.uniform(3.1, 3.7) : random.uniform(2.6, 2.9), 0.05);
  type.plinth = rounded(random.uniform(0.3, is_block ? 1.2 : 0.6), 0.05);
  type.roof = choose_roof(housing, random);
  type.roof_slope = rounded(random.uniform(0.7, 1.1), 0.05);
  type.window_width = rounded(random.uniform(1.0, 1.35), 0.05);
  type.window_height = rounded(is_block ? random.uniform(1.7, 2.1) : random.uniform(1.25, 1.5), 0.05);
  type.num_axes = std::max(2, static_cast<int>(type.width / (type.window_width + random.uniform(1.0, 1.5))));
  type.door_axis = static_cast<int>(random.index(static_cast<std::size_t>(type.num_axes)));
  type.sill = is_block ? 0.8 : 0.9;
  type.recess = rounded(random.uniform(0.08, 0.24), 0.02);
  add_extensions(type, housing, random);
  type.has_brick = random.chance(0.4);
  type.has_dormers = type.roof == RoofKind::kAlong && random.chance(0.5);
  type.stand_back = is_block ? 0.0 : rounded(random.uniform(0, 1.2), 0.1);
  return type;
}

}  // namespace

std::vector<HouseType> make_house_types(Housing housing, std::size_t count, Random& random) {
  std::vector<HouseType> types;
  for (std::size_t i = 0; i < count; ++i) types.push_back(make_type(housing, random));
  return types;
}

}  // namespace vdbmap::simulator
