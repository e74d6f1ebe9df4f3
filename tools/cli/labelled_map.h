// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "vdbmap/core/voxel_map.h"

namespace vdbmap::cli {

/// A map, or all of a city, whose voxels have SemanticKITTI's labels. Throws IoError as load_map_or_city() does, and
/// (malformed) where it has none.
VoxelMap load_labelled_map(const std::filesystem::path& path);

}  // namespace vdbmap::cli
