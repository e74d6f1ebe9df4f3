// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "vdbmap/io/vdb/map_check.h"

namespace vdbmap {

/// What was found in a file of a city.
struct CityProblem {
  std::filesystem::path file;
  std::string what;
};

struct CityCheckResult {
  std::size_t num_epochs = 0;
  std::size_t num_tiles = 0;  ///< of all epochs, each file once
  std::size_t num_parts = 0;  ///< likewise
  std::vector<CityProblem> problems;
};

/// Judges a city: its manifests, every tile of every epoch by the rules of check_map_file(), every sum of the parts
/// that it keeps, and whether all agree. Goes on after what is wrong: all of it is listed. `on_tile_done` is called
/// after each tile and part, by any thread. Throws IoError where there is no manifest to begin with.
CityCheckResult check_city(
    const std::filesystem::path& folder, const std::function<void()>& on_tile_done = [] {});

}  // namespace vdbmap
