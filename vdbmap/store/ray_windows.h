// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <vector>

#include "vdbmap/change/ray_evidence.h"
#include "vdbmap/core/posed_cloud.h"
#include "vdbmap/store/city_folder.h"
#include "vdbmap/store/tile_findings.h"

namespace vdbmap {

/// Follows rays through one or two cities of a layout in windows of their tiles, and finds when points fell into the
/// voxels of the last of them.
///
/// Rays are collected by the tile in which they end. Where they take a quarter of the memory, those of one tile after
/// the other are followed, as many tiles at a time as the windows have room for: those that rays go through before they
/// are out of range, and those in which they end, whose surfaces decide where they stop. What is found is summed tile
/// by tile. As it is sums and unions, it does not depend on where rays were cut, and is that of RayEvidence and
/// presence_of() of the whole maps. The least window are the tiles of the rays that end in one tile.
class RayWindows {
 public:
  /// Keeps references. `folder` is there and empty.
  RayWindows(std::vector<const City*> cities, const RayTrust& trust, std::size_t memory_bytes,
             const std::filesystem::path& folder);

  /// Takes the rays of a cloud. Throws IoError for tiles that cannot be read, and where the disk is full.
  void add(const PosedCloud& posed);

  /// Follows the rays that are left.
  void finish();

  const FindingsFolder& findings() const { return findings_; }

  /// The tiles of which something was found.
  const std::set<TileId>& tiles() const { return tiles_; }

  /// Those, and the tiles next to voxels that rays went through or points fell into: as far as neighbours decide about
  /// a voxel.
  const std::set<TileId>& tiles_nearby() const { return tiles_nearby_; }

 private:
  // The rays that end in a tile.
  struct Bundle {
    std::vector<MeasuredRay> rays;  // [m, local frame]
    std::vector<VoxelIndex> cells;  // in which they end
    std::set<TileId> tiles;         // that they need
  };

  void follow_all();
  void follow(const std::vector<const Bundle*>& bundles, const std::set<TileId>& tiles);
  void keep(const std::vector<VoxelMap>& windows, const RayEvidence& evidence, const std::vector<TimeBins>& presence);
  std::size_t bytes_of(const TileId& tile) const;

  std::vector<const City*> cities_;
  RayTrust trust_;
  double voxel_size_;
  std::int32_t voxels_per_tile_;
  std::int32_t reach_;  // [voxels] of neighbours
  std::size_t most_rays_;
  std::size_t window_bytes_;
  FindingsFolder findings_;
  std::map<TileId, Bundle> bundles_;
  std::size_t num_rays_ = 0;
  std::set<TileId> tiles_;
  std::set<TileId> tiles_nearby_;
};

/// Adds the tiles that a ray needs [m, local frame]: those it goes through up to `max_range` and the one in which it
/// ends, and those that either comes as near as `tolerance` to.
void add_tiles_of_ray(const MeasuredRay& ray, double max_range, double tolerance, std::set<TileId>& tiles);

}  // namespace vdbmap
