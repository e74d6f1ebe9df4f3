// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "vdbmap/io/las/las_records.h"
#include "vdbmap/io/points/coordinate_kind.h"

namespace vdbmap {

/// Where on earth the coordinates of a LAS file are, as far as its records say.
struct LasReferenceSystem {
  std::optional<int> epsg;
  std::optional<double> metres_per_unit;
  CoordinateKind kind = CoordinateKind::kUnknown;
  std::vector<ReadFinding> findings;  ///< damaged records, which say nothing
};

/// Reads the GeoTIFF keys and the WKT record; the one that the header prefers wins, the other fills what it lacks.
LasReferenceSystem find_reference_system(const LasHeader& header, const std::vector<LasRecord>& records);

}  // namespace vdbmap
