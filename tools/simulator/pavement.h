// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "tools/simulator/street_layout.h"
#include "tools/simulator/vegetation.h"
#include "tools/simulator/world.h"

namespace vdbmap::simulator {

/// Adds what stands on the pavements for years: trees, lamps, signs and bollards. Trees are appended to `trees`.
void add_pavement(World& world, Mesh& mesh, const StreetLayout& layout, std::vector<Tree>& trees, Random& random);

}  // namespace vdbmap::simulator
