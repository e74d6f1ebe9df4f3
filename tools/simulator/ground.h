// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/simulator/street_layout.h"
#include "tools/simulator/world.h"

namespace vdbmap::simulator {

/// Adds road, parking lanes, kerbs, pavements, driveways, side streets and gardens.
void add_ground(World& world, Mesh& mesh, const StreetLayout& layout);

}  // namespace vdbmap::simulator
