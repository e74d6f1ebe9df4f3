// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vdbmap::cli {

/// A name for each file, for legends: its own, with as much of the folders above it as tells it from the others.
std::vector<std::string> short_names(const std::vector<std::filesystem::path>& files);

}  // namespace vdbmap::cli
