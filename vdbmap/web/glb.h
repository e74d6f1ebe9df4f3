// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

#include "vdbmap/web/tile_points.h"

namespace vdbmap {

/// What a glTF file of a tile says beside its points.
struct GlbOptions {
  double voxel_size = 0;  ///< [m]
  bool has_color = false;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of the file's coordinates [m, local frame of the map]
  std::string details;  ///< address of the tile's file of details, from this one; empty: none
};

/// A binary glTF 2.0 file of voxels as points: mode POINTS, positions in bytes (KHR_mesh_quantization), vertices
/// compressed (EXT_meshopt_compression), a node a block. Its axes are glTF's, y up, and 3D Tiles turn them back.
///
/// Attributes: POSITION, the voxel's index from the node's extras `min_index`; COLOR_0, linear; and _VOXEL, four bytes:
/// code of the label, Change, AirFaces, age. Extras of a node are `voxel_size`, `min_index` and, where there are
/// details, `details`, their address, and `first_detail`, the number there of the node's first point. Equal points give
/// equal bytes. Throws std::invalid_argument without blocks.
std::string glb_of(std::span<const TileBlock> blocks, const GlbOptions& options);

}  // namespace vdbmap
