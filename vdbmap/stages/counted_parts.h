// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vdbmap/stages/source_part.h"
#include "vdbmap/store/city_folder.h"

namespace vdbmap {

/// All parts of a job together: what every reduce and the finish must see alike.
struct CountedParts {
  std::optional<City> base;              ///< that is added to
  std::vector<Part> parts;               ///< that are counted, in the order of their names and hashes
  std::vector<MapSource> sources;        ///< theirs, of the epoch that the city is in afterwards
  std::vector<std::string> not_counted;  ///< names of sources that are in the city already, or twice among the parts
  std::vector<LeftOutSource> left_out;
  InputNotes notes;   ///< of the parts that are counted
  CityLayout added;   ///< of their points alone
  CityLayout layout;  ///< of the city afterwards
  std::int32_t epoch = 0;
};

/// Opens the parts of all sources that the plan names and are not left out. Throws IoError where one is missing, and as
/// open_part(), and as read_inputs() does for sources that do not go together. Throws std::invalid_argument where no
/// source has points.
CountedParts open_parts(const Job& job);

}  // namespace vdbmap
