// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "vdbmap/change/map_update.h"
#include "vdbmap/store/ray_windows.h"
#include "vdbmap/store/tile_finish.h"
#include "vdbmap/store/tile_groups.h"
#include "vdbmap/store/tile_renewal.h"

namespace vdbmap {

/// The tiles of a city that a drive changes: judged first, as groups of voxels go over borders, then made anew. Each is
/// that of the map in one piece that update_map() makes. Keeps a reference to the findings of the rays.
class DrivenTiles {
 public:
  /// `drive` is a city of the drive's points alone, and `rays` were followed through both, the city first.
  DrivenTiles(const City& city, const City& drive, const RayWindows& rays, UpdateOptions options);

  /// Of the city with the drive in it.
  const CityLayout& layout() const { return layout_; }

  /// The tiles that may change, sorted.
  const std::vector<TileId>& ids() const { return ids_; }

  /// Finds which voxels are gone, and which held something that moved. Throws IoError.
  void judge();

  /// Makes the tiles anew once they are judged, those without a voxel of which nothing is known left out.
  /// `on_tile_done` is called by any thread. Throws IoError.
  std::vector<CityTile> make(const SaveTile& save, const std::function<void()>& on_tile_done);

  /// What became of the voxels of these tiles, once they are made.
  const UpdateCounts& counts() const { return counts_; }

 private:
  // Tiles that are loaded, of both.
  struct Neighborhoods {
    TileNeighborhood map;
    TileNeighborhood drive;
  };

  // A tile and its margin.
  struct Windows {
    VoxelMap map;
    VoxelMap drive;
  };

  // Grades of a tile's own voxels.
  struct Grades {
    std::vector<SeenGrade> map;
    std::vector<SeenGrade> drive;
  };

  template <typename Body>
  void in_batches(const Body& body) const;
  Windows windows_of(const TileId& id, const Neighborhoods& near) const;
  Grades grade(const TileId& id, const Neighborhoods& near) const;
  std::optional<CityTile> make_tile(const TileId& id, const Neighborhoods& near, UpdateCounts& counts,
                                    const SaveTile& save) const;
  std::optional<Visibility> visibility_before(const TileId& id, const Neighborhoods& near,
                                              const VoxelLevel& window) const;
  std::optional<Visibility> visibility_of(const TileId& id, const Neighborhoods& near, const Windows& windows,
                                          const VoxelFates& fates, const VoxelMap& after, const VoxelMap& tile) const;

  std::optional<City> city_;
  std::optional<City> drive_;
  const FindingsFolder& findings_;
  UpdateOptions options_;
  CityLayout layout_;
  double margin_;  // [m]
  TileGroups gone_;
  TileGroups moved_;
  std::vector<TileId> ids_;
  UpdateCounts counts_;
};

}  // namespace vdbmap
