// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "vdbmap/core/map_builder.h"
#include "vdbmap/io/map_inputs.h"

namespace vdbmap {

struct MapFromFilesOptions {
  BuildOptions build;  ///< without `epsg`, that of the files in map coordinates is taken
  InputOptions inputs;
};

/// A map, and what was noticed in the files.
struct MapFromFiles {
  VoxelMap map;
  InputNotes notes;
};

/// The map of all points in the scans. Throws as read_inputs() and check_any_point() do, and
/// std::invalid_argument for bad options.
MapFromFiles build_map_from_files(const std::vector<MapInput>& inputs, const MapFromFilesOptions& options = {});

}  // namespace vdbmap
