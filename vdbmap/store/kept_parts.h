// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "vdbmap/store/city_folder.h"
#include "vdbmap/store/part_file.h"
#include "vdbmap/store/tile_renewal.h"

/// The sums of a city's sources: whole numbers, of which its tiles are made anew bit for bit, with a source more, less
/// or another.
namespace vdbmap {

/// A source of a city and its sums.
struct KeptSource {
  MapSource source;
  CityPart kept;
  Part part;
};

/// Opens the part of a source. Throws IoError, malformed: it is missing, was cut, or is not what its name says.
KeptSource open_kept_source(const std::filesystem::path& folder, const MapSource& source, const CityPart& part);

/// The parts of all sources of a city that keeps them. Throws IoError as open_kept_source().
std::vector<KeptSource> open_kept_sources(const City& city);

/// Reads all sums of a part. Throws IoError where they are damaged.
void check_sums(const Part& part);

/// Tiles of what sources these are, made of nothing but their sums.
class TilesOfSources {
 public:
  /// Keeps a reference to the sources. Tiles have the attributes of all of their points. `like` has the frame, levels
  /// and density, and epochs if tiles are to have them. Throws IoError where sources do not go together.
  TilesOfSources(std::span<const KeptSource> sources, const CityLayout& like);

  const CityLayout& layout() const { return layout_; }

  /// The tiles in which, or near which, a source has points, sorted.
  std::vector<TileId> ids() const;

  /// Those of `ids` that have voxels, finished and saved, one a thread at a time; `ids` is sorted. Throws IoError.
  std::vector<CityTile> make(std::span<const TileId> ids, const SaveTile& save,
                             const std::function<void()>& on_tile_done) const;

 private:
  VoxelMap make(const TileId& id) const;

  CityLayout layout_;
  std::map<std::int32_t, TilesOfParts> places_;  // by the epoch of the source
};

/// The tiles of which these parts have sums.
std::set<TileId> tiles_touched_by(std::span<const KeptSource> sources);

}  // namespace vdbmap
