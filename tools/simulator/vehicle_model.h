// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/simulator/vehicle_shape.h"
#include "tools/simulator/world.h"

namespace vdbmap::simulator {

/// Draws a vehicle about the origin of the brush's frame: x forward, y left, wheels on z = 0. The brush's material is
/// its paint. Its windows let light through to seats and dashboard.
void add_vehicle(const Brush& paint, const VehicleShape& shape, const StandardMaterials& materials);

/// The same for a vehicle of any body.
void add_any_vehicle(const Brush& paint, const VehicleShape& shape, const World& world);

}  // namespace vdbmap::simulator
