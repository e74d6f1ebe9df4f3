// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "vdbmap/core/tile_id.h"
#include "vdbmap/core/voxel_map.h"
#include "vdbmap/store/city_folder.h"

namespace vdbmap {

/// The voxels of one epoch of a site: the finest level of a map file, or of a city, of which only what is asked for is
/// in memory.
class SiteSource {
 public:
  /// Throws IoError, also for a map without voxels.
  explicit SiteSource(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  const CityLayout& layout() const { return layout_; }
  double voxel_size() const { return layout_.voxel_sizes.front(); }  ///< [m] of the finest level
  bool has_channel(const std::string& name) const;                   ///< "label", "last_epoch", ...
  std::int32_t newest_epoch() const { return newest_epoch_; }        ///< in which a voxel was seen, or the city's

  /// The tiles that have voxels, sorted.
  const std::vector<TileId>& tiles() const { return tiles_; }

  /// The leaves whose lowest voxels lie in a box [voxels], with their records and channels. Throws IoError, also where
  /// the city was changed since it was opened.
  VoxelLevel load(const openvdb::CoordBBox& box) const;

 private:
  void take(VoxelMap map);
  void take(City city);

  std::filesystem::path path_;
  CityLayout layout_;
  std::int32_t newest_epoch_ = 0;
  std::vector<TileId> tiles_;
  std::variant<std::monostate, VoxelMap, City> voxels_;
};

}  // namespace vdbmap
