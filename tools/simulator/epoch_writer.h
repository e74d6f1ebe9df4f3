// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include <nlohmann/json_fwd.hpp>

#include "tools/simulator/simulate.h"
#include "tools/simulator/street.h"

namespace vdbmap::simulator {

/// Surveys an epoch with the sensors that `options` name for it, and writes clouds, scans, poses, labels and vehicles
/// into `folder`. What the scanners were and how they drove is added to `drives`. Throws IoError.
EpochResult write_epoch(const std::filesystem::path& folder, const Street& street, int epoch,
                        const SimulateOptions& options, nlohmann::ordered_json& drives);

/// The sensors of an epoch, each once.
std::vector<Sensor> sensors_of_epoch(const SimulateOptions& options, int epoch);

/// "mapper", "vlp16", "hdl64".
const char* name_of(Sensor sensor);

}  // namespace vdbmap::simulator
