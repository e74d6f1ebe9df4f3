// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

namespace vdbmap {

/// The folder of the built page (tools/web) that comes with the program; nothing where it was built without.
std::optional<std::filesystem::path> default_page();

}  // namespace vdbmap
