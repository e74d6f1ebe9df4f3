// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "vdbmap/io/las_header.h"

namespace vdbmap {

/// Where on earth the coordinates of a LAS file are, as far as its records say.
struct LasReferenceSystem {
  std::optional<int> epsg;
  std::optional<double> metres_per_unit;
};

/// Reads the GeoTIFF keys and the WKT record; the one that the header prefers wins, the other fills what it lacks.
/// Throws IoError where the GeoTIFF keys are cut off.
LasReferenceSystem find_reference_system(const std::filesystem::path& path, const LasHeader& header,
                                         const std::vector<LasRecord>& records);

}  // namespace vdbmap
