// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

namespace vdbmap::test {

/// A tile with a glTF file as a viewer of 3D Tiles finds it.
struct TilesetTile {
  std::filesystem::path content;
  Eigen::Affine3d world_from_tile;
  Eigen::AlignedBox3d box;  ///< its bounding volume, in its frame
  double error = 0;         ///< [m]
  bool is_leaf = false;
  std::optional<std::size_t> parent;  ///< the nearest tile with a glTF file above it, by its number in the list
};

/// All tiles with glTF files of a tileset, parents before children, through tilesets in tilesets. Throws where a file
/// is missing, is no JSON or lacks what 3D Tiles 1.1 requires.
std::vector<TilesetTile> tiles_of_tileset(const std::filesystem::path& tileset);

}  // namespace vdbmap::test
