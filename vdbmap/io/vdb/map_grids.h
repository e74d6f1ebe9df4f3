// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "vdbmap/core/voxel_level.h"
#include "vdbmap/io/vdb/standard_grids.h"
#include "vdbmap/io/vdb/streamed_grid.h"

/// Grids that every reader of .vdb files understands, one value a voxel.
namespace vdbmap {

/// What is added to the grid names of a level: "" for the finest of a map, "_1m" or "_500mm" for the others.
std::string level_suffix(double voxel_size, bool is_finest);

/// The transform of a level's grids: voxel (i,j,k) covers [i s, (i+1) s), so OpenVDB's cell centres are shifted by s/2.
openvdb::math::Transform::Ptr transform_of_level(double voxel_size);

/// What is wrong with the transform of a grid of a level, for a message: another program may have moved, turned or
/// scaled it; empty where nothing is.
std::string problem_of_level_transform(const openvdb::math::Transform& transform, double voxel_size);

/// The voxel size [m] that a stated one means: the nearest that a level may have, as other programs carry sizes in
/// single precision. Nothing where that is more than 1e-6 of it away.
std::optional<double> exact_voxel_size(double stated);

/// A grid over all voxels of the level with the values that value_of(record number) gives. It can only be written, and
/// keeps a reference to the level.
template <typename Grid, typename ValueOf>
typename Grid::Ptr make_channel_grid(const VoxelLevel& level, const ValueOf& value_of) {
  auto grid = std::make_shared<StreamedGrid<Grid>>(level, value_of);
  grid->setTransform(transform_of_level(level.voxel_size()));
  return grid;
}

/// A fog of one density in every voxel, for renderers.
openvdb::FloatGrid::Ptr make_density_grid(const VoxelLevel& level, float density);

/// Mean colour of every voxel, linear RGB 0..1.
openvdb::Vec3SGrid::Ptr make_color_grid(const VoxelLevel& level);

}  // namespace vdbmap
