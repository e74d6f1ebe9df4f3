// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/map_tiles.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <stdexcept>
#include <utility>

#include "vdbmap/core/parallel.h"
#include "vdbmap/core/voxel_block.h"

namespace vdbmap {
namespace {

// A leaf of one of several levels of one voxel size, and where its records go.
struct LeafSource {
  VoxelKey key;
  const VoxelLevel* level;
  const VoxelLeaf* leaf;
  std::size_t first_record = 0;

  bool operator<(const LeafSource& other) const { return key < other.key; }
};

// The leaves of a level that `is_wanted`, in tree order.
template <typename IsWanted>
void list_leaves(const VoxelLevel& level, const IsWanted& is_wanted, std::vector<LeafSource>& sources) {
  for (const VoxelLeaf& leaf : level.leaves()) {
    if (is_wanted(leaf)) sources.push_back({key_of_voxel(leaf.origin()), &level, &leaf});
  }
}

// The leaves of each tile, in tree order.
std::map<TileId, std::vector<LeafSource>> group_by_tile(const VoxelLevel& level) {
  const std::int32_t per_tile = voxels_per_tile(level.voxel_size());
  std::map<TileId, std::vector<LeafSource>> groups;
  for (const VoxelLeaf& leaf : level.leaves()) {
    groups[tile_of_voxel(leaf.origin(), per_tile)].push_back({key_of_voxel(leaf.origin()), &level, &leaf});
  }
  return groups;
}

// Numbers the records; returns how many there are.
std::size_t lay_out_records(std::vector<LeafSource>& sources) {
  std::size_t num_records = 0;
  for (LeafSource& source : sources) {
    source.first_record = num_records;
    num_records += source.leaf->getValueMask().countOn();
  }
  return num_records;
}

template <typename From, typename To>
void copy_records(const LeafSource& source, const From& from, To& to) {
  const auto begin = from.begin() + static_cast<std::ptrdiff_t>(source.leaf->transientData());
  std::copy_n(begin, source.leaf->getValueMask().countOn(),
              to.begin() + static_cast<std::ptrdiff_t>(source.first_record));
}

// The level of these leaves, which are sorted. Those of `like` decide which channels there are.
VoxelLevel level_of(std::vector<LeafSource> sources, const VoxelLevel& like) {
  const std::size_t num_records = lay_out_records(sources);
  LargeVector<VoxelLeaf> leaves;
  leaves.reserve(sources.size());
  for (const LeafSource& source : sources) leaves.push_back(*source.leaf);
  LargeVector<VoxelRecord> records(num_records);
  VoxelChannels channels;
  for_each_channel([&](const char* /*name*/, auto channel) {
    if (!(like.channels().*channel).empty()) (channels.*channel).resize(num_records);
  });
  parallel_for(
      sources.size(),
      [&](std::size_t i) {
        const LeafSource& source = sources[i];
        copy_records(source, source.level->records(), records);
        for_each_channel([&](const char* /*name*/, auto channel) {
          if (!(channels.*channel).empty()) copy_records(source, source.level->channels().*channel, channels.*channel);
        });
      },
      256);
  return {like.voxel_size(), std::move(leaves), std::move(records), std::move(channels)};
}

VoxelMap without_levels(const VoxelMap& map) { return {map.frame, {}, map.has_color, map.label_scheme}; }

bool have_same_channels(const VoxelLevel& a, const VoxelLevel& b) {
  bool are_same = true;
  for_each_channel([&](const char* /*name*/, auto channel) {
    are_same &= (a.channels().*channel).empty() == (b.channels().*channel).empty();
  });
  return are_same;
}

void check_alike(const VoxelMap& a, const VoxelMap& b) {
  const auto is_alike = [](const VoxelLevel& x, const VoxelLevel& y) { return x.voxel_size() == y.voxel_size(); };
  const bool are_alike = a.frame == b.frame && a.has_color == b.has_color && a.label_scheme == b.label_scheme &&
                         std::ranges::equal(a.levels, b.levels, is_alike);
  if (!are_alike) throw std::invalid_argument("maps of different frames, levels or attributes cannot be spliced");
}

// A level of `maps` that has voxels, if there is one: empty levels have no channels.
const VoxelLevel& occupied_level(std::span<const VoxelMap> maps, std::size_t number) {
  for (const VoxelMap& map : maps) {
    if (map.levels[number].size() > 0) return map.levels[number];
  }
  return maps.front().levels[number];
}

VoxelLevel splice_level(std::span<const VoxelMap> maps, std::size_t number) {
  std::vector<LeafSource> sources;
  for (const VoxelMap& map : maps)
    list_leaves(
        map.levels[number], [](const VoxelLeaf&) { return true; }, sources);
  parallel_sort(sources, std::less<>());
  // Of levels without voxels nothing is known: those with some are compared.
  const VoxelLevel& like = occupied_level(maps, number);
  for (const VoxelMap& map : maps) {
    if (map.levels[number].size() > 0 && !have_same_channels(map.levels[number], like)) {
      throw std::invalid_argument("maps of different attributes cannot be spliced");
    }
  }
  const auto same_key = [](const LeafSource& a, const LeafSource& b) { return a.key == b.key; };
  if (std::ranges::adjacent_find(sources, same_key) != sources.end()) {
    throw std::invalid_argument("maps that have a leaf in common cannot be spliced");
  }
  return level_of(std::move(sources), like);
}

}  // namespace

std::vector<TileId> tiles_of(const VoxelMap& map) {
  std::vector<TileId> tiles;
  for (const VoxelLevel& level : map.levels) {
    const std::int32_t per_tile = voxels_per_tile(level.voxel_size());
    for (const VoxelLeaf& leaf : level.leaves()) {
      const TileId tile = tile_of_voxel(leaf.origin(), per_tile);
      if (tiles.empty() || tile != tiles.back()) tiles.push_back(tile);
    }
  }
  std::ranges::sort(tiles);
  tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
  return tiles;
}

VoxelMap cut_tile(const VoxelMap& map, const TileId& tile, double margin) {
  VoxelMap part = without_levels(map);
  for (const VoxelLevel& level : map.levels) {
    const std::int32_t per_tile = voxels_per_tile(level.voxel_size());
    const std::int32_t margin_voxels = margin_in_voxels(margin, level.voxel_size());
    const auto is_wanted = [&](const VoxelLeaf& leaf) {
      return contains(tiles_around(leaf.origin(), VoxelLeaf::DIM, margin_voxels, per_tile), tile);
    };
    std::vector<LeafSource> sources;
    list_leaves(level, is_wanted, sources);
    part.levels.push_back(level_of(std::move(sources), level));
  }
  return part;
}

VoxelLevel cut_leaves(const VoxelLevel& level, const openvdb::CoordBBox& box) {
  std::vector<LeafSource> sources;
  list_leaves(
      level, [&](const VoxelLeaf& leaf) { return box.isInside(leaf.origin()); }, sources);
  return level_of(std::move(sources), level);
}

void for_each_tile(const VoxelMap& map, const std::function<void(const TileId&, const VoxelMap&)>& body) {
  std::vector<std::map<TileId, std::vector<LeafSource>>> leaves_of_tile;  // one a level
  for (const VoxelLevel& level : map.levels) leaves_of_tile.push_back(group_by_tile(level));
  for (const TileId& tile : tiles_of(map)) {
    VoxelMap part = without_levels(map);
    for (std::size_t i = 0; i < map.levels.size(); ++i) {
      part.levels.push_back(level_of(std::move(leaves_of_tile[i][tile]), map.levels[i]));
    }
    body(tile, part);
  }
}

VoxelMap empty_map(const MapFrame& frame, const std::vector<double>& voxel_sizes) {
  VoxelMap map;
  map.frame = frame;
  for (const double size : voxel_sizes) map.levels.push_back({size, {}, {}});
  return map;
}

VoxelMap splice(std::span<const VoxelMap> maps) {
  if (maps.empty()) throw std::invalid_argument("no maps to splice");
  for (const VoxelMap& map : maps.subspan(1)) check_alike(maps.front(), map);
  VoxelMap whole = without_levels(maps.front());
  for (std::size_t i = 0; i < maps.front().levels.size(); ++i) whole.levels.push_back(splice_level(maps, i));
  return whole;
}

}  // namespace vdbmap
