// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "vdbmap/core/map_history.h"

namespace vdbmap {

/// A history as JSON, as the metadata `history` of map files holds it. Equal histories give equal texts.
std::string text_of(const MapHistory& history);

/// Reads what text_of() wrote. Throws IoError (malformed) naming `path` for anything else.
MapHistory parse_map_history(std::string_view text, const std::filesystem::path& path);

}  // namespace vdbmap
