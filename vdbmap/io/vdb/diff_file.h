// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "vdbmap/change/map_diff.h"
#include "vdbmap/io/vdb/map_file.h"

namespace vdbmap {

/// Writes a diff as a .vdb file, atomically; equal diffs give equal bytes. Throws IoError.
///
/// It is a map of what appeared, vanished and changed: the voxels of the maps that they are of, but in green, red and
/// amber, so that `density` and `color` show it in Blender and every command that takes a map takes it. Beside that map
/// lie the grids `appeared`, `vanished` and `changed`, the confidence of each voxel, and `unobserved`, 1 in each voxel.
void save_diff(const std::filesystem::path& path, const MapDiff& diff, const SaveOptions& options = {});

/// Whether a .vdb file holds a diff, by its grids. Throws IoError as load_map() does.
bool is_diff_file(const std::filesystem::path& path);

/// Reads what save_diff() wrote. Throws IoError naming the file and the reason, also for maps and other .vdb files.
MapDiff load_diff(const std::filesystem::path& path);

}  // namespace vdbmap
