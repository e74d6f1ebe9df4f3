// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "vdbmap/core/tile_id.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap {

/// The tiles in which a map has voxels, sorted.
std::vector<TileId> tiles_of(const VoxelMap& map);

/// What a map has in one tile: leaves and records as they are, on all levels. Normals keep what they saw beyond the
/// border. With a margin [m], leaves too that begin within it around the tile.
VoxelMap cut_tile(const VoxelMap& map, const TileId& tile, double margin = 0);

/// Calls body(tile, part) for every tile of tiles_of(), in their order, with what cut_tile() cuts.
void for_each_tile(const VoxelMap& map, const std::function<void(const TileId&, const VoxelMap&)>& body);

/// The margin [m] in which a tile's voxels have their neighbours, on all levels: one voxel of the coarsest. Of a map
/// that has the voxels of a tile and of its margin on the finest level, the tile's own normals and coarser levels are
/// those of the whole map, bit for bit.
inline double neighbor_margin(const std::vector<double>& voxel_sizes) { return voxel_sizes.back(); }

/// A map of these levels without voxels.
VoxelMap empty_map(const MapFrame& frame, const std::vector<double>& voxel_sizes);

/// The leaves of a level whose lowest voxels lie in a box, with their records as they are.
VoxelLevel cut_leaves(const VoxelLevel& level, const openvdb::CoordBBox& box);

/// One map of several that have no leaf in common, like those that cut_tile() makes of one: leaves and records are
/// copied, nothing is computed, so the tiles of a map give that map again, bit for bit, in whatever order they come.
///
/// Throws std::invalid_argument without maps, and where frames, voxel sizes, attributes or label schemes differ or two
/// maps have the same leaf.
VoxelMap splice(std::span<const VoxelMap> maps);

}  // namespace vdbmap
