// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "tools/simulator/street_layout.h"
#include "tools/simulator/world.h"

namespace vdbmap::simulator {

/// Adds what an epoch finds elsewhere than the next: people, bicycles and bins. `seed` is the street's.
void add_passers_by(World& world, Mesh& mesh, const StreetLayout& layout, int epoch, std::uint64_t seed);

}  // namespace vdbmap::simulator
