// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "vdbmap/core/voxel_map.h"

namespace vdbmap {

/// The map of all points of two maps: equals building from all of them, to the rounding of the records. A voxel that
/// only one map has keeps its record but for the normal, which sees its new neighbours; coarser levels are made anew.
///
/// The frame is that of `a`; a map without voxels leaves the choice of the anchor to the other, a map without EPSG code
/// that of the code. What only one map knows is taken from it: in voxels of both, colour, intensity, label and epochs
/// are those of the map that has them; a voxel of the other map alone gets black, intensity 0, no label and epoch 0.
/// Where both have labels, that of the map with more points in the voxel wins, the lower of equals: maps do not keep
/// the votes of their points. With one anchor, merge_maps(b, a) gives the same bits.
///
/// Throws std::invalid_argument where EPSG codes, voxel sizes or label schemes differ, naming both, and
/// std::out_of_range where a voxel of `b` cannot be addressed from the anchor of `a`.
VoxelMap merge_maps(const VoxelMap& a, const VoxelMap& b);

}  // namespace vdbmap
