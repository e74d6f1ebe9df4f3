// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "vdbmap/core/voxel_map.h"
#include "vdbmap/store/city_window.h"

namespace vdbmap {

/// A map that is looked into at places: one in memory, or a city of which the tiles around these places are loaded and
/// those of places left behind are forgotten. Copies share what is loaded; several threads may look at a time.
class MapWindows {
 public:
  /// Every window is the map. Keeps a reference to it.
  MapWindows(const VoxelMap& map);  // NOLINT(google-explicit-constructor): whoever looks into a map takes either

  /// The same, and owns the map.
  MapWindows(VoxelMap&& map);  // NOLINT(google-explicit-constructor)

  /// The chosen tiles of a city, of which none is loaded yet. Beside the windows in use the last two are kept, and more
  /// up to `kept_bytes`.
  MapWindows(City city, const TileChoice& is_wanted, std::size_t kept_bytes = std::size_t{400} << 20);

  /// The city, and those of its tiles that are looked at; nothing of a map in memory.
  const City* city() const;
  std::span<const CityTile> tiles() const;

  /// Of the levels [m], finest first.
  std::vector<double> voxel_sizes() const;

  /// All of the map, but of a city without the finest level, which has no voxels then. Throws IoError as load_window().
  const VoxelMap& overview() const;

  /// What lies less than `radius` [m] from a place [m, original system] in plan, and more: whole tiles. Which tiles
  /// depends on the place and the radius alone. Throws IoError as load_window(), and where the city was changed since
  /// a part of it was loaded and keeps the epoch no more.
  std::shared_ptr<const VoxelMap> around(const Eigen::Vector3d& place, double radius) const;

 private:
  struct CityWindows;

  std::shared_ptr<const VoxelMap> whole_;
  std::shared_ptr<CityWindows> city_;
};

}  // namespace vdbmap
