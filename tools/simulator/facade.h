// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "tools/simulator/random.h"
#include "tools/simulator/world.h"

namespace vdbmap::simulator {

/// A rectangle of a wall [m]: x along it, z up.
struct WallPatch {
  double left;
  double right;
  double bottom;
  double top;
};

/// A wall in the plane y = 0 of the brush's frame, with holes that do not overlap.
void add_wall(const Brush& brush, const WallPatch& wall, const std::vector<WallPatch>& holes);

/// What fills a hole in a wall: reveals, frame, glass and what is seen behind it, `recess` [m] behind the wall.
void add_window(const Brush& wall, const WallPatch& hole, double recess, const StandardMaterials& materials,
                Random& random);

/// A door `recess` [m] behind the wall, and steps down to z = 0.
void add_door(const Brush& wall, const WallPatch& hole, double recess, const StandardMaterials& materials);

/// A slab that juts out by `depth` [m] below a window, with a railing of bars.
void add_balcony(const Brush& wall, const WallPatch& floor, double depth, const StandardMaterials& materials);

}  // namespace vdbmap::simulator
