// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vdbmap/store/city_build.h"
#include "vdbmap/store/city_folder.h"

namespace vdbmap {

/// What becomes of the sources of a city.
struct SourceChanges {
  std::vector<MapInput> inputs;          ///< that are to be counted, in the order in which they are
  std::vector<MapSource> sources;        ///< these inputs, with their epochs
  std::vector<MapSource> removed;        ///< of the city, sorted as there
  std::vector<std::string> not_counted;  ///< names of inputs that are in the city already, or twice among the inputs
  std::vector<std::string> not_found;    ///< what was to be removed and is no source

  bool empty() const { return inputs.empty() && removed.empty(); }
};

/// What inputs and options say of the sources of a city, or of a new one. Throws IoError for files that cannot be read,
/// and std::invalid_argument for a name that several sources bear, a source that is to be replaced but is none while
/// its successor is not counted, and where no source would be left.
SourceChanges find_changes(const std::optional<City>& base, const std::vector<MapInput>& inputs,
                           const CityBuildOptions& options);

}  // namespace vdbmap
