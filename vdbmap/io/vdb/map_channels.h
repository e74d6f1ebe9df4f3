// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "vdbmap/core/voxel_map.h"
#include "vdbmap/io/vdb/map_file.h"

namespace vdbmap {

/// How channels are written.
struct ChannelOptions {
  /// Density of the fog that renderers see [1/m].
  float density = SaveOptions().density;
  /// Whole numbers in FloatGrids, for readers without Int32Grid, Debian's python3-openvdb among them.
  bool integers_as_float = false;
};

/// Writes every attribute of every level as a standard grid, the coarser levels with the voxel size in the name:
/// `density`, `count`, `mean` (offset from the voxel's centre [m]), `cov_diag`, `cov_offdiag`, `normal`, `planarity`,
/// and where the map has them `color`, `intensity`, `label`, `first_epoch`, `last_epoch`. Throws IoError, and
/// std::invalid_argument where a float cannot hold a whole number.
void export_channels(const std::filesystem::path& path, const VoxelMap& map, const ChannelOptions& options = {});

/// Reads channels of any origin. An exported map comes back bit for bit. Required are `count`, `mean`, `cov_diag` and
/// `cov_offdiag` over the same voxels; missing normals are computed, as is the 1 m level where the file is not one of
/// ours. Whole numbers may stand in Int32 or float grids. Throws IoError naming the grid and the reason.
VoxelMap import_channels(const std::filesystem::path& path);

}  // namespace vdbmap
