// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/simulator/random.h"
#include "tools/simulator/world.h"

namespace vdbmap::simulator {

/// Where a thing is drawn, and out of what.
struct Site {
  Brush brush;  ///< its frame: x along the street, y away from it, z up, the origin on the ground in the thing's middle
  World& world;    ///< for materials
  Random& random;  ///< the thing's own
  double length;   ///< [m] of the room that it has along the street
  double width;    ///< [m] across
  bool is_winter;  ///< leaves are off

  /// A brush of a new material.
  Brush paint(SurfaceClass label, const Eigen::Vector3f& color, float reflectance, float gloss = 0,
              Texture texture = Texture::kPlain) const {
    return brush.with(world.add_material({label, color, reflectance, 0, gloss, texture}));
  }
  const StandardMaterials& standard() const { return world.standard(); }
};

}  // namespace vdbmap::simulator
