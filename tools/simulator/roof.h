// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/simulator/house_type.h"
#include "tools/simulator/world.h"

namespace vdbmap::simulator {

/// The roof of a house whose walls end at the height `eaves` [m]: x along the street from 0 to the type's width, y to
/// the back from 0 to its depth; the brush's material is that of the walls. With chimney, dormers, gutter and pipe.
void add_roof(const Brush& house, const HouseType& type, double eaves, MaterialId tiles,
              const StandardMaterials& materials);

}  // namespace vdbmap::simulator
