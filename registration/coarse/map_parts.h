// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "registration/coarse/feature_matches.h"
#include "registration/coarse/surface_points.h"
#include "vdbmap/core/tile_id.h"

namespace vdbmap::registration {

/// Features of one tile of a map that can be matched.
struct TileFeatures {
  TileId tile;
  std::vector<std::uint32_t> numbers;  ///< of the features, rising
};

/// Groups chosen features by the tiles of their points; tiles rise.
std::vector<TileFeatures> group_by_tile(const SurfacePoints& points, std::vector<std::uint32_t> chosen);

/// A part of a map: positions of its tiles among all of them, rising.
using MapPart = std::vector<std::size_t>;

/// Squares of 256 m, 128 m from one to the next, that together hold all tiles, each with at least 64 m around it in one
/// of them. Squares without tiles are left out, and those whose tiles are all in another.
std::vector<MapPart> overlapping_parts(const std::vector<TileFeatures>& tiles);

/// What match_features() gives of each tile, for every part the same as of all of its features together, but for the
/// last bits of distances.
class TileMatches {
 public:
  TileMatches(const FpfhMatrix& source, const std::vector<std::uint32_t>& chosen_source, const FpfhMatrix& target,
              std::span<const TileFeatures> tiles, int num_nearest);

  std::vector<FeatureMatch> of_part(const MapPart& part) const;

 private:
  std::size_t num_sources_;
  std::size_t num_nearest_;
  std::vector<std::vector<FeatureMatch>> nearest_;  // of each tile: those of the first source, of the second, ...
  std::vector<std::size_t> per_source_;             // of each tile
};

}  // namespace vdbmap::registration
