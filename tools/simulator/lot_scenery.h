// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "tools/simulator/street_layout.h"
#include "tools/simulator/vegetation.h"
#include "tools/simulator/world.h"

namespace vdbmap::simulator {

/// Adds what stands on a lot: a house with its front garden, a driveway with gate and garage, or the houses of a side
/// street. Trees get their wood; they are appended to `trees` for their crowns.
void add_lot(World& world, Mesh& mesh, const StreetLayout& layout, const SideLayout& side, const Lot& lot,
             std::vector<Tree>& trees);

}  // namespace vdbmap::simulator
