// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

#include "tools/cli/build_inputs.h"
#include "tools/cli/reading.h"
#include "vdbmap/io/map_from_files.h"
#include "vdbmap/store/city_build.h"

namespace vdbmap::cli {

/// What `build` tells beside what it made.
struct BuildReport {
  const InputNotes& notes;
  const ChosenInputs& chosen;
  ReadingReport reading;
  double seconds = 0;
};

/// Logs what is doubtful in the files' units and systems; `epsg` is the map's.
void warn_of(const InputNotes& notes, const std::optional<int>& epsg);

/// Prints what was made of the files, a map or a city, and of which.
void print_built(const MapFromFiles& built, const std::filesystem::path& file, const BuildReport& report, bool as_json);
void print_built(const CityBuilt& built, const std::filesystem::path& folder, const BuildReport& report, bool as_json);

}  // namespace vdbmap::cli
