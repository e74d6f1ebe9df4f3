// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "vdbmap/core/voxel_map.h"

namespace vdbmap::cli {

/// What a map in a file holds, a line a fact. Bytes a voxel are those of all levels, over the voxels of the finest.
std::string text_of_map(const VoxelMap& map, const std::filesystem::path& file);

/// The same for machines; what is unknown is null.
nlohmann::ordered_json json_of_map(const VoxelMap& map, const std::filesystem::path& file);

}  // namespace vdbmap::cli
