// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "tools/simulator/material.h"

namespace vdbmap::simulator {

/// Materials as lasers find them on a real day: panes send next to nothing back, every seventh material is dirty and
/// darker; on a wet day the ground is dark and glossy.
std::vector<Material> weathered(std::vector<Material> materials, bool is_wet, std::uint64_t seed);

/// Whether an epoch is a wet day.
bool is_wet(std::uint64_t seed, int epoch);

}  // namespace vdbmap::simulator
