// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/city_diff.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "vdbmap/core/map_tiles.h"
#include "vdbmap/store/seen_window.h"

namespace vdbmap {
namespace {

// A map file, all of it, or a city, window by window.
class StoredMap {
 public:
  explicit StoredMap(const std::filesystem::path& path) {
    if (is_city(path)) {
      city_ = open_city(path);
    } else {
      whole_ = load_seen_map(path);
    }
  }

  bool is_in_tiles() const { return city_.has_value(); }
  const CityManifest& manifest() const { return city_->manifest; }
  const MapFrame& frame() const { return city_ ? city_->manifest.layout.frame : whole_->map.frame; }
  bool has_rays() const { return city_ ? vdbmap::has_rays(city_->manifest) : whole_->visibility.has_value(); }
  std::optional<Extent> box() const { return city_ ? extent(city_->manifest) : extent(whole_->map); }

  std::vector<TileId> tiles() const {
    if (!city_) return tiles_of(whole_->map);
    std::vector<TileId> ids;
    for (const CityTile& tile : city_->manifest.tiles) ids.push_back(tile.id);
    return ids;
  }

  // The map, or what of it lies in some tiles.
  SeenMap window(const TileRange& range) {
    if (!city_) return whole_->seen();
    window_ = load_seen_window(*city_, [&](const CityTile& tile) { return contains(range, tile.id); });
    return window_->seen();
  }

 private:
  std::optional<City> city_;
  std::optional<LoadedMap> whole_;
  std::optional<LoadedMap> window_;
};

// What is added to tiles of the earlier map to have those of the later one's frame.
TileId tile_shift(const StoredMap& earlier, const StoredMap& later) {
  const Eigen::Vector3d tiles = (earlier.frame().anchor - later.frame().anchor) / kTileSize;
  constexpr double kFar = 1 << 20;  // beyond, no tile is one of the other
  return {static_cast<std::int32_t>(std::lround(std::clamp(tiles.x(), -kFar, kFar))),
          static_cast<std::int32_t>(std::lround(std::clamp(tiles.y(), -kFar, kFar)))};
}

TileId moved(const TileId& tile, const TileId& by) { return {tile.x + by.x, tile.y + by.y}; }
TileId opposite(const TileId& shift) { return {-shift.x, -shift.y}; }

std::set<TileId> blocks_of(StoredMap& earlier, StoredMap& later, std::int32_t side) {
  const TileId shift = tile_shift(earlier, later);
  std::set<TileId> blocks;
  const auto add = [&](const TileId& tile) { blocks.insert({floor_divide(tile.x, side), floor_divide(tile.y, side)}); };
  for (const TileId& tile : earlier.tiles()) add(moved(tile, shift));
  for (const TileId& tile : later.tiles()) add(tile);
  return blocks;
}

TileRange tiles_of_block(const TileId& block, std::int32_t side) {
  return {{block.x * side, block.y * side}, {block.x * side + side - 1, block.y * side + side - 1}};
}

TileRange with_margin(const TileRange& range) {
  return {{range.low.x - 1, range.low.y - 1}, {range.high.x + 1, range.high.y + 1}};
}

openvdb::CoordBBox box_of_tiles(const TileRange& range, double voxel_size) {
  const std::int32_t per_tile = voxels_per_tile(voxel_size);
  openvdb::CoordBBox box = openvdb::CoordBBox::inf();
  box.min().x() = range.low.x * per_tile;
  box.min().y() = range.low.y * per_tile;
  box.max().x() = (range.high.x + 1) * per_tile - 1;
  box.max().y() = (range.high.y + 1) * per_tile - 1;
  return box;
}

std::set<std::pair<TileId, std::string>> files_in(const CityManifest& manifest, const TileRange& range) {
  std::set<std::pair<TileId, std::string>> files;
  for (const CityTile& tile : manifest.tiles) {
    if (contains(range, tile.id)) files.emplace(tile.id, tile.hash);
  }
  return files;
}

bool is_same_in_both(const StoredMap& earlier, const StoredMap& later, const TileRange& range,
                     const DiffOptions& options) {
  return earlier.is_in_tiles() && later.is_in_tiles() && earlier.frame() == later.frame() &&
         options.earlier_from_later.isApprox(Eigen::Isometry3d::Identity(), 0) &&
         files_in(earlier.manifest(), range) == files_in(later.manifest(), range);
}

MapDiff unchanged_tiles(const CityManifest& manifest, const TileRange& range) {
  const VoxelMap empty = empty_map(manifest.layout.frame, manifest.layout.voxel_sizes);
  MapDiff diff = map_diff({empty}, {empty});
  for (const CityTile& tile : manifest.tiles) {
    if (contains(range, tile.id)) diff.counts.unchanged += tile.num_voxels.front();
  }
  return diff;
}

bool have_common_point(const std::optional<Extent>& a, const std::optional<Extent>& b) {
  return a && b && (a->min.array() <= b->max.array()).all() && (b->min.array() <= a->max.array()).all();
}

MapDiff diff_in_blocks(StoredMap& earlier, StoredMap& later, const StoredDiffOptions& options) {
  const TileId to_earlier = opposite(tile_shift(earlier, later));
  const std::set<TileId> blocks = blocks_of(earlier, later, options.tiles_at_once);
  std::vector<MapDiff> parts;
  for (const TileId& block : blocks) {
    const TileRange range = tiles_of_block(block, options.tiles_at_once);
    if (is_same_in_both(earlier, later, range, options.diff)) {
      parts.push_back(unchanged_tiles(later.manifest(), range));
    } else {
      const TileRange read = with_margin(range);
      const SeenMap earlier_window = earlier.window({moved(read.low, to_earlier), moved(read.high, to_earlier)});
      const SeenMap later_window = later.window(read);
      parts.push_back(map_diff_in(box_of_tiles(range, later_window.map.finest().voxel_size()), earlier_window,
                                  later_window, options.diff));
    }
    options.on_block_done(parts.size(), blocks.size());
  }
  return join_diffs(parts);
}

}  // namespace

StoredDiff diff_stored_maps(const std::filesystem::path& earlier_path, const std::filesystem::path& later_path,
                            const StoredDiffOptions& options) {
  options.diff.check();
  if (options.tiles_at_once < 1) throw std::invalid_argument("blocks have one tile at least");
  StoredMap earlier(earlier_path), later(later_path);
  const TileRange all;
  const bool is_in_tiles = earlier.is_in_tiles() || later.is_in_tiles();
  const bool has_voxels = earlier.box() || later.box();
  StoredDiff result{is_in_tiles && has_voxels ? diff_in_blocks(earlier, later, options)
                                              : map_diff(earlier.window(all), later.window(all), options.diff)};
  result.earlier_has_rays = earlier.has_rays();
  result.later_has_rays = later.has_rays();
  result.do_overlap = have_common_point(earlier.box(), later.box());
  return result;
}

}  // namespace vdbmap
