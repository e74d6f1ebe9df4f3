// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "vdbmap/core/visibility.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap::cli {

/// A map, or all of a city, whose voxels have SemanticKITTI's labels. Throws IoError as load_map_or_city() does, and
/// (malformed) where it has none.
VoxelMap load_labelled_map(const std::filesystem::path& path);

/// What rays said of a map, where its file says so; nothing of a city.
std::optional<Visibility> visibility_of(const std::filesystem::path& path, const VoxelMap& map);

/// The date of the latest epoch of a map, where its file says so; else empty.
std::string date_of_map(const std::filesystem::path& path);

}  // namespace vdbmap::cli
