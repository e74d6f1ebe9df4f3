// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "tools/simulator/simulate_options.h"

namespace vdbmap::simulator {

struct SimulateResult {
  std::vector<EpochResult> epochs;
  std::size_t num_spaces = 0;
  std::size_t num_changed_voxels = 0;
};

/// Makes a street and writes its surveys and their truth into the folder `out`, which appears whole or not at all. A
/// folder that is there already is replaced if it is empty or an earlier simulation; else IoError (malformed) says what
/// is in it. The same options give the same bytes for any number of threads. Throws IoError and std::invalid_argument.
SimulateResult simulate(const std::filesystem::path& out, const SimulateOptions& options);

}  // namespace vdbmap::simulator
