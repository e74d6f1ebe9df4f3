// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/coarse/map_parts.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "vdbmap/core/parallel.h"

namespace vdbmap::registration {
namespace {

constexpr std::int32_t kPartTiles = 4;  // along each side of a part
constexpr std::int32_t kStepTiles = 2;  // from one part to the next

bool is_nearer(const FeatureMatch& a, const FeatureMatch& b) {
  return std::tie(a.distance, a.target) < std::tie(b.distance, b.target);
}

}  // namespace

std::vector<TileFeatures> group_by_tile(const SurfacePoints& points, std::vector<std::uint32_t> chosen) {
  std::ranges::sort(chosen);
  std::map<TileId, std::vector<std::uint32_t>> groups;
  for (const std::uint32_t number : chosen) groups[tile_of_point(points.positions[number])].push_back(number);
  std::vector<TileFeatures> tiles;
  for (auto& [tile, numbers] : groups) tiles.push_back({tile, std::move(numbers)});
  return tiles;
}

std::vector<MapPart> overlapping_parts(const std::vector<TileFeatures>& tiles) {
  std::map<TileId, MapPart> parts;  // by their lowest tile, in steps
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const TileId high = {floor_divide(tiles[i].tile.x, kStepTiles), floor_divide(tiles[i].tile.y, kStepTiles)};
    for (std::int32_t x = high.x - kPartTiles / kStepTiles + 1; x <= high.x; ++x) {
      for (std::int32_t y = high.y - kPartTiles / kStepTiles + 1; y <= high.y; ++y) parts[{x, y}].push_back(i);
    }
  }
  const auto is_covered = [&](const std::pair<const TileId, MapPart>& part) {
    for (std::int32_t x = part.first.x - 1; x <= part.first.x + 1; ++x) {
      for (std::int32_t y = part.first.y - 1; y <= part.first.y + 1; ++y) {
        const auto other = parts.find({x, y});
        if (other == parts.end() || other->first == part.first) continue;
        if (other->second.size() > part.second.size() && std::ranges::includes(other->second, part.second)) return true;
      }
    }
    return false;
  };
  std::vector<MapPart> list;
  for (const auto& part : parts) {
    if (!is_covered(part)) list.push_back(part.second);
  }
  return list;
}

TileMatches::TileMatches(const FpfhMatrix& source, const std::vector<std::uint32_t>& chosen_source,
                         const FpfhMatrix& target, std::span<const TileFeatures> tiles, int num_nearest)
    : num_sources_(chosen_source.size()),
      num_nearest_(static_cast<std::size_t>(num_nearest)),
      nearest_(tiles.size()),
      per_source_(tiles.size()) {
  parallel_for(tiles.size(), [&](std::size_t i) {
    nearest_[i] = match_features(source, chosen_source, target, tiles[i].numbers, num_nearest);
    per_source_[i] = std::min(num_nearest_, tiles[i].numbers.size());
    std::ranges::sort(nearest_[i], [](const FeatureMatch& a, const FeatureMatch& b) {
      return std::tie(a.source, a.distance, a.target) < std::tie(b.source, b.distance, b.target);
    });
  });
}

std::vector<FeatureMatch> TileMatches::of_part(const MapPart& part) const {
  std::vector<FeatureMatch> matches;
  std::vector<FeatureMatch> of_source;
  for (std::size_t source = 0; source < num_sources_; ++source) {
    of_source.clear();
    for (const std::size_t tile : part) {
      const auto begin = nearest_[tile].begin() + static_cast<std::ptrdiff_t>(source * per_source_[tile]);
      of_source.insert(of_source.end(), begin, begin + static_cast<std::ptrdiff_t>(per_source_[tile]));
    }
    const auto kept = static_cast<std::ptrdiff_t>(std::min(num_nearest_, of_source.size()));
    std::partial_sort(of_source.begin(), of_source.begin() + kept, of_source.end(), is_nearer);
    matches.insert(matches.end(), of_source.begin(), of_source.begin() + kept);
  }
  sort_best_first(matches);
  return matches;
}

}  // namespace vdbmap::registration
