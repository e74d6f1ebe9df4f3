// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

#include "vdbmap/core/map_history.h"
#include "vdbmap/core/visibility.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap {

/// How a map is written.
struct SaveOptions {
  /// Density of the fog that renderers see [1/m]; 10 cm of the default let 1 % of the light through.
  float density = 50.0f;
};

/// Writes a map as a .vdb file: for every level `voxels` (all attributes), `density` and `color`, the coarser ones with
/// the voxel size in the name. Atomic; equal maps give equal bytes. Throws IoError.
void save_map(const std::filesystem::path& path, const VoxelMap& map, const SaveOptions& options = {});

/// What a map file may keep beside the voxels; load_map() does not read it.
struct MapExtras {
  std::optional<Visibility> visibility;  ///< what rays said (visibility_file.h)
  MapHistory history;                    ///< from what the map was made
};

/// The same with what is known beside the voxels.
void save_map(const std::filesystem::path& path, const VoxelMap& map, const MapExtras& extras,
              const SaveOptions& options = {});

/// Whether a .vdb file holds a map, which may still be damaged inside; reads no voxel of it. Throws IoError as
/// load_map() does, but not for files of other programs.
bool is_map_file(const std::filesystem::path& path);

/// Reads what save_map() wrote. Throws IoError naming the file and the reason, also for .vdb files of other programs.
VoxelMap load_map(const std::filesystem::path& path);

/// The same without the finest level, which is not read: a map has most of its voxels there.
VoxelMap load_coarser_levels(const std::filesystem::path& path);

/// Reads from what a map file was made; empty where it does not say. Throws IoError.
MapHistory load_history(const std::filesystem::path& path);

}  // namespace vdbmap
