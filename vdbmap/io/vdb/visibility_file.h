// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

#include "vdbmap/core/visibility.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap {

/// Reads what rays said of the finest level of a map file; nothing where the map was built without rays. Throws IoError
/// where it is not of this map: of another voxel size, or not of its voxels.
std::optional<Visibility> load_visibility(const std::filesystem::path& path, const VoxelMap& map);

}  // namespace vdbmap
