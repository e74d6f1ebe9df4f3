// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace vdbmap {

/// Why a text file in a folder of scans is none, from its name and its first lines: "is named like a table of poses",
/// "holds poses", "has a column qx". Empty where it may be one.
std::string reason_no_scan(const std::filesystem::path& table);

}  // namespace vdbmap
