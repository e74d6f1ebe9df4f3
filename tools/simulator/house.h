// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "tools/simulator/house_type.h"
#include "tools/simulator/world.h"

namespace vdbmap::simulator {

/// Where a house stands: x along its front, from 0 to its width, y to its back.
struct HouseSite {
  Eigen::Isometry3d scene_from_house;
  HouseType type;
  Housing housing;
  std::uint64_t seed;
};

void add_house(World& world, Mesh& mesh, const HouseSite& site);

}  // namespace vdbmap::simulator
