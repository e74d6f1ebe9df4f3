// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "vdbmap/core/voxel_level.h"
#include "vdbmap/io/vdb/standard_grids.h"

/// A level of a map as an OpenVDB PointDataGrid: one point a voxel, at its mean, with all attributes.
///
/// The points lie in cells of 4 x 4 x 4 voxels. With one voxel a cell, a leaf would hold some 35 points and cost 500
/// bytes beside them: 14 bytes a voxel on KITTI streets, against 1 with the larger cells.
namespace vdbmap {

/// Edge of the grid's cells in voxels.
inline constexpr int kVoxelsPerCell = 4;

/// All voxels of the level with all attributes; `Cd` only where `has_color`.
openvdb::points::PointDataGrid::Ptr make_voxel_grid(const VoxelLevel& level, bool has_color);

/// A level read back from its voxel grid, and whether it has colours.
struct ReadLevel {
  VoxelLevel level;
  bool has_color;
};

/// Reads what make_voxel_grid() made, and takes the leaves of the grid. Throws IoError naming `path`, the grid and what
/// is missing or wrong.
ReadLevel read_voxel_grid(openvdb::points::PointDataGrid& grid, const std::filesystem::path& path);

}  // namespace vdbmap
