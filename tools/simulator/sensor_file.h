// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "tools/simulator/sensor_use.h"

namespace vdbmap::simulator {

/// Reads sensors from JSON: an array of objects, each with "name" and what it changes of a model or makes of its own.
///
///     [{"name": "roof", "model": "vlp16", "epoch": 1, "height": 1.9, "tilt_deg": 5},
///      {"name": "dense", "elevations_deg": [-20, -10, -5, 0, 5], "rate": 20, "firings": 900, "range": 80, "noise":
///      0.02}]
///
/// `model`: a sensor that has a name. An entry named "mapper" is the mobile mapper; it takes `epoch` only. `beams` with
/// `lowest_deg` and `highest_deg`, or `elevations_deg`: 1 to 256 beams. `rate` [1/s] 1..50, `firings` a turn 36..4096,
/// `range` [m] 5..300, `noise` [m] 0..0.2, `height` [m] 0.3..5, `tilt_deg` nose down -45..45, `epoch`: every one where
/// it is missing. Throws IoError (malformed) naming the sensor and the key.
std::vector<SensorUse> read_sensors(const std::filesystem::path& path);

}  // namespace vdbmap::simulator
