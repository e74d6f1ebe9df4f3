// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "vdbmap/change/seen_through.h"
#include "vdbmap/core/tile_id.h"
#include "vdbmap/core/voxel_block.h"
#include "vdbmap/core/voxel_level.h"

namespace vdbmap {

/// Groups of touching voxels that are likely or sure to be seen through, over the borders of tiles: find_seen_through()
/// of a whole map, tile by tile. Keeps 12 bytes a voxel with a grade.
class TileGroups {
 public:
  explicit TileGroups(const SeenThroughOptions& options) : options_(options) {}

  /// The next tile, in any order, and the grades of its own voxels, one a record.
  void add(const TileId& tile, const VoxelLevel& level, const std::vector<SeenGrade>& grades);

  /// One value a record of a tile of that many records, 1 where it was seen through; all tiles were added. Of a tile
  /// that was not, none was.
  std::vector<std::uint8_t> seen_through(const TileId& tile, std::size_t num_records) const;

 private:
  // A voxel with a grade.
  struct Member {
    std::uint32_t record;
    std::uint32_t group;
    bool is_sure;
  };

  // Groups that turn out to be one have one root, which has the sums.
  struct Group {
    std::uint32_t parent;
    std::size_t num_voxels = 0;
    std::size_t num_sure = 0;
  };

  std::uint32_t root_of(std::uint32_t group) const;
  void unite(std::uint32_t a, std::uint32_t b);

  SeenThroughOptions options_;
  std::map<TileId, std::vector<Member>> members_;
  std::vector<Group> groups_;
  std::map<VoxelKey, std::uint32_t> on_borders_;  // groups of voxels at the borders of tiles
};

}  // namespace vdbmap
