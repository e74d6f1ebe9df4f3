// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "vdbmap/core/visibility.h"
#include "vdbmap/core/voxel_map.h"
#include "vdbmap/io/vdb/vdb_file.h"

namespace vdbmap {

/// The grids of what rays said of the finest level of a map: `hits` and `passes` of its voxels (int32), and
/// `seen_empty` (bool), whole cubes of it as one tile. The makers keep references to both.
std::vector<GridMaker> visibility_grids(const VoxelMap& map, const Visibility& visibility);

/// Reads what rays said of the finest level of a map file; nothing where the map was built without rays. Throws IoError
/// where it is not of this map: of another voxel size, or not of its voxels.
std::optional<Visibility> load_visibility(const std::filesystem::path& path, const VoxelMap& map);

/// Whether a map file says what rays saw; reads no voxel.
bool has_visibility(const std::filesystem::path& path);

}  // namespace vdbmap
