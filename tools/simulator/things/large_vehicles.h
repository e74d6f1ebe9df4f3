// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/simulator/vehicle_shape.h"
#include "tools/simulator/world.h"

namespace vdbmap::simulator {

/// Draws a box van, truck, bus, caravan, trailer or motorcycle as add_vehicle() draws cars: x forward, y left, wheels
/// on z = 0, the brush's material its paint.
void add_large_vehicle(const Brush& paint, const VehicleShape& shape, const VehicleMaterials& materials);

/// A front door that stands open on the left (+1) or right (-1) of a car, at an angle [rad] to its side.
void add_open_door(const Brush& paint, const VehicleShape& shape, double side, double angle,
                   const VehicleMaterials& materials);

}  // namespace vdbmap::simulator
