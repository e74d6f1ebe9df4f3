// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "vdbmap/io/poses/trajectory_file.h"
#include "vdbmap/store/map_windows.h"

namespace vdbmap::cli {

/// Where in a map scans are looked for.
struct SearchArea {
  std::vector<double> near;           ///< x, y and radius [m, original system]; empty: everywhere
  std::optional<Trajectory> guesses;  ///< of the scans, one each; a single one says where the first of them is
  double reach = 0;                   ///< [m] of the sensor
};

/// The map in one file, or of a city the tiles in reach, to be loaded where they are looked at: those that a scan near
/// the place, or from one of the guesses, can see. All of it without a place, and where a single guess says only where
/// the scans begin. Throws IoError, also where no tile is in reach.
MapWindows open_search_area(const std::filesystem::path& map, const SearchArea& area);

}  // namespace vdbmap::cli
