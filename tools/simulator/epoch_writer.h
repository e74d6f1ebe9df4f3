// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include <nlohmann/json_fwd.hpp>

#include "tools/simulator/simulate_options.h"
#include "tools/simulator/street.h"

namespace vdbmap::simulator {

/// Surveys an epoch with the sensors that `options` name for it, and writes clouds, scans, poses, labels and vehicles
/// into `folder`. What the scanners were and how they drove is added to `drives`. Throws IoError.
EpochResult write_epoch(const std::filesystem::path& folder, const Street& street, int epoch,
                        const SimulateOptions& options, nlohmann::ordered_json& drives);

}  // namespace vdbmap::simulator
