// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <openvdb/math/Coord.h>

#include "vdbmap/web/quad_tile.h"
#include "vdbmap/web/site_placement.h"

namespace vdbmap {

/// The file of a tile.
struct TileFile {
  QuadTile tile;
  openvdb::CoordBBox voxels;   ///< around the voxels, of the tile's level
  std::string name;            ///< "0_12_-3.HASH.glb"
  std::size_t num_points = 0;  ///< in the file
  std::size_t num_bytes = 0;   ///< of the file
};

/// Tiles of all levels by their place; each has its parent, up to those of the highest level.
using TileFiles = std::map<QuadTile, TileFile>;

/// A JSON file of a tileset.
struct TilesetFile {
  std::string name;  ///< in the site
  std::string json;
};

/// The origin of a tile's file [m, local frame]: centre of the tile's square, height of its lowest voxel.
Eigen::Vector3d origin_of_tile(const QuadTile& tile, const openvdb::CoordBBox& voxels, const SiteGrid& grid);

/// The box in which a tile's place on the globe is exact at the corners [m, local frame]: its square, its heights.
Eigen::AlignedBox3d box_of_tile(const QuadTile& tile, const openvdb::CoordBBox& voxels, const SiteGrid& grid);

/// The tileset (OGC 3D Tiles 1.1) of the tiles of an epoch, "tileset_ID.json" first: a quadtree in which children
/// replace their parent. A tile's error is its voxel size, 0 on the finest level. Each tile is placed by an affine
/// transformation of its own. Beyond 1024 tiles, subtrees of 64 m have a file each. `tiles_path` leads from the
/// tileset's folder to that of the tiles' files, "../../tiles/".
std::vector<TilesetFile> tileset_of(const TileFiles& tiles, const SiteGrid& grid, const SitePlacement& placement,
                                    const std::string& id);

}  // namespace vdbmap
