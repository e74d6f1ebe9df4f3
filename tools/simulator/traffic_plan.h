// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "tools/simulator/drive.h"
#include "tools/simulator/route.h"
#include "tools/simulator/traffic.h"

namespace vdbmap::simulator {

/// Who is on the way while a survey drives along a route: a vehicle ahead and one behind, vehicles that come towards it
/// at up to 50 km/h, cyclists, walkers on the pavements and across the street. Nobody runs into the survey or into
/// `obstacles` [m, scene frame], which stand in the carriageway. Adds each to the world's objects, as of `epoch`.
Traffic plan_traffic(World& world, const Route& route, const DriveOptions& drive, double duration,
                     const std::vector<Eigen::Vector2d>& obstacles, int epoch, std::uint64_t seed);

}  // namespace vdbmap::simulator
