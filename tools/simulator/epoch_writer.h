// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "tools/simulator/simulate_options.h"
#include "tools/simulator/simulation_record.h"
#include "tools/simulator/street.h"

namespace vdbmap::simulator {

/// Surveys an epoch with the sensors that `options` name for it, and writes clouds, scans, poses, labels and vehicles
/// into `folder`. What moves meanwhile becomes part of the street's world. Throws IoError.
EpochResult write_epoch(const std::filesystem::path& folder, Street& street, int epoch, const SimulateOptions& options,
                        SimulationRecord& record);

}  // namespace vdbmap::simulator
