// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace vdbmap::simulator {

/// Throws unless a simulation may appear at `folder`: IoError (malformed) for a folder that holds anything but an
/// earlier simulation, std::invalid_argument for the folder in which the program runs.
void check_output_folder(const std::filesystem::path& folder);

}  // namespace vdbmap::simulator
