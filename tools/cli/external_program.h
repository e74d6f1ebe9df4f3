// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace vdbmap::cli {

/// Runs a program of the system, without a shell, and returns what it writes to stdout. Throws IoError (system) where
/// it is not there or fails, with the first line that it says.
std::string output_of_program(const std::vector<std::string>& command);

}  // namespace vdbmap::cli
