// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <vector>

#include "vdbmap/change/presence.h"
#include "vdbmap/core/tile_id.h"
#include "vdbmap/core/voxel_tree.h"

namespace vdbmap {

/// What rays and points said of a tile of one or two maps.
struct TileFindings {
  /// Of a map: one value a record of the tile's finest level.
  struct OfMap {
    std::vector<std::uint32_t> passes;  ///< rays that went through what the voxel holds
    std::vector<TimeBins> pass_times;   ///< when
  };

  std::vector<OfMap> maps;
  std::vector<TimeBins> presence;  ///< when points fell into the voxels of the last map
  VoxelTree seen_empty{{}};        ///< voxels that rays went through and no map occupies

  /// Whether anything was found.
  bool is_any() const;
};

/// Findings of the same tile of the same maps: sums and unions, in whatever order they come.
void add(TileFindings& to, const TileFindings& more);

/// Findings tile by tile in files, while rays are followed window by window. Files are of one process and gone at its
/// end.
class FindingsFolder {
 public:
  /// `folder` is there and empty.
  explicit FindingsFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Adds to what is known of a tile. Several threads may add to different tiles at a time. Throws IoError.
  void add(const TileId& tile, TileFindings findings) const;

  /// What is known of a tile; nothing where nothing was found. Throws IoError.
  std::optional<TileFindings> read(const TileId& tile) const;

 private:
  std::filesystem::path path_of(const TileId& tile) const;

  std::filesystem::path folder_;
};

}  // namespace vdbmap
