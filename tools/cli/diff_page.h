// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vdbmap/change/change_regions.h"
#include "vdbmap/change/map_diff.h"

namespace vdbmap::cli {

/// What a page of changes is about.
struct DiffPage {
  std::filesystem::path earlier;
  std::filesystem::path later;
  std::vector<std::string> dates;  ///< of both; without: what the maps know
};

/// Draws the page and writes it. Throws IoError.
void write_diff_page(const std::filesystem::path& output, const DiffPage& page, const MapDiff& diff,
                     const std::vector<ChangeRegion>& regions);

}  // namespace vdbmap::cli
