// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/tile_finish.h"

#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/core/hierarchy.h"
#include "vdbmap/core/map_merge.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/core/normals.h"
#include "vdbmap/core/parallel_tasks.h"
#include "vdbmap/store/city_window.h"

namespace vdbmap {
namespace {

std::array<TileId, 9> tiles_in_and_around(const TileId& tile) {
  std::array<TileId, 9> tiles;
  for (int i = 0; i < 9; ++i) tiles[static_cast<std::size_t>(i)] = {tile.x + i / 3 - 1, tile.y + i % 3 - 1};
  return tiles;
}

bool has_channel(const CityLayout& layout, const char* name) {
  return std::ranges::find(layout.channels, name) != layout.channels.end();
}

bool has_labels(const CityLayout& layout) { return has_channel(layout, "label"); }

LabelScheme merged_scheme(const CityLayout& a, const CityLayout& b) {
  if (!has_labels(a) || !has_labels(b)) return has_labels(a) ? a.label_scheme : b.label_scheme;
  if (a.label_scheme == b.label_scheme) return a.label_scheme;
  if (a.label_scheme == LabelScheme::kUnknown || b.label_scheme == LabelScheme::kUnknown) return LabelScheme::kUnknown;
  throw std::invalid_argument("labels of " + std::string(text_of(b.label_scheme)) + " do not go into a city of " +
                              std::string(text_of(a.label_scheme)));
}

// The finest level of the sums, without normals, and no voxels on the others.
VoxelMap map_of_sums(VoxelBlocks sums, const FinestLevelOptions& finest, const CityLayout& layout) {
  VoxelMap map = empty_map(layout.frame, layout.voxel_sizes);
  map.has_color = layout.has_color;
  map.label_scheme = layout.label_scheme;
  map.levels.front() = make_finest_level(std::move(sums), nullptr, finest);
  return map;
}

void complete(VoxelMap& map, const std::vector<double>& voxel_sizes) {
  map.levels.erase(map.levels.begin() + 1, map.levels.end());
  compute_normals(map.levels.front());
  add_coarser_levels(map, voxel_sizes);
}

// The channels that the layout has, filled where the level has none.
VoxelLevel with_channels(VoxelLevel level, const std::vector<std::string>& names) {
  VoxelChannels channels = level.channels();
  bool is_complete = true;
  for_each_channel([&](const char* name, auto channel) {
    auto& values = channels.*channel;
    const bool is_wanted = std::ranges::find(names, name) != names.end();
    if (!is_wanted || values.size() == level.size()) return;
    values.resize(level.size());
    is_complete = false;
  });
  if (is_complete) return level;
  const std::span<const VoxelLeaf> leaves = level.leaves();
  const std::span<const VoxelRecord> records = std::as_const(level).records();
  return {level.voxel_size(), {leaves.begin(), leaves.end()}, {records.begin(), records.end()}, std::move(channels)};
}

// An epoch in which a voxel was seen. By voxel and epoch they are sorted.
struct SeenVoxel {
  VoxelKey voxel;
  std::int32_t epoch;

  auto operator<=>(const SeenVoxel&) const = default;
};

std::vector<SeenVoxel> seen_voxels(const std::vector<EpochSums>& epochs) {
  std::vector<SeenVoxel> seen;
  for (const EpochSums& epoch : epochs) {
    for (const auto& [block, content] : epoch.sums) {
      for (const KeyedSums& voxel : content.sums) seen.push_back({key_of_voxel(block, voxel.key), epoch.epoch});
    }
  }
  std::ranges::sort(seen);
  return seen;
}

// Records are in the order of their voxels' keys.
void add_epochs(VoxelChannels& channels, const std::vector<SeenVoxel>& seen) {
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (i > 0 && seen[i].voxel == seen[i - 1].voxel) {
      channels.last_epochs.back() = seen[i].epoch;
      continue;
    }
    channels.first_epochs.push_back(seen[i].epoch);
    channels.last_epochs.push_back(seen[i].epoch);
  }
}

VoxelBlocks sums_of_all(std::vector<EpochSums> epochs) {
  VoxelBlocks all = std::move(epochs.front().sums);
  for (EpochSums& epoch : std::span(epochs).subspan(1)) {
    for (auto& [block, content] : epoch.sums) add_content(all[block], std::move(content));
  }
  return all;
}

}  // namespace

void TileNeighborhood::load_around(std::span<const TileId> tiles) {
  if (!city_) return;
  std::set<TileId> needed;
  for (const TileId& tile : tiles) {
    for (const TileId& id : tiles_in_and_around(tile)) needed.insert(id);
  }
  std::erase_if(loaded_, [&](const auto& entry) { return !needed.contains(entry.first); });
  std::vector<CityTile> missing;
  for (const TileId& id : needed) {
    const CityTile* tile = find_tile(city_->manifest, id);
    if (tile && !loaded_.contains(id)) missing.push_back(*tile);
  }
  std::vector<std::optional<VoxelMap>> maps(missing.size());
  parallel_tasks(missing.size(), [&](std::size_t i) { maps[i] = load_present_tile(*city_, missing[i]); });
  for (std::size_t i = 0; i < missing.size(); ++i) {
    loaded_.emplace(missing[i].id, std::move(*maps[i]));
  }
}

const VoxelMap* TileNeighborhood::tile(const TileId& tile) const {
  const auto found = loaded_.find(tile);
  return found == loaded_.end() ? nullptr : &found->second;
}

std::optional<VoxelMap> TileNeighborhood::window(const TileId& tile, double margin) const {
  std::vector<VoxelMap> parts;
  for (const TileId& id : tiles_in_and_around(tile)) {
    const auto found = loaded_.find(id);
    if (found != loaded_.end()) parts.push_back(cut_tile(found->second, tile, margin));
  }
  std::erase_if(parts, [](const VoxelMap& part) { return part.finest().size() == 0; });
  return parts.empty() ? std::nullopt : std::optional(splice(parts));
}

CityLayout merged_layout(const CityLayout& city, const CityLayout& added) {
  const std::optional<int> epsg = city.frame.epsg;
  if (epsg && added.frame.epsg && *epsg != *added.frame.epsg) {
    throw std::invalid_argument("points of EPSG:" + std::to_string(*added.frame.epsg) +
                                " do not go into a city of EPSG:" + std::to_string(*epsg));
  }
  CityLayout merged = city;
  merged.frame.epsg = epsg ? epsg : added.frame.epsg;
  merged.has_color |= added.has_color;
  merged.label_scheme = merged_scheme(city, added);
  merged.channels.clear();
  for_each_channel([&](const char* name, auto /*channel*/) {
    const auto has = [&](const CityLayout& layout) {
      return std::ranges::find(layout.channels, name) != layout.channels.end();
    };
    if (has(city) || has(added)) merged.channels.emplace_back(name);
  });
  return merged;
}

VoxelMap finish_tile(const TileId& tile, VoxelBlocks sums, const FinestLevelOptions& finest,
                     const std::optional<VoxelMap>& before, const CityLayout& added, const CityLayout& layout) {
  VoxelMap fresh = map_of_sums(std::move(sums), finest, added);
  if (!before) {
    complete(fresh, layout.voxel_sizes);
    return in_layout(cut_tile(fresh, tile), layout);
  }
  VoxelMap old = *before;
  for (VoxelMap* map : {&old, &fresh}) {
    map->frame = layout.frame;
    map->label_scheme = layout.label_scheme;
  }
  return in_layout(cut_tile(merge_maps(old, fresh), tile), layout);
}

FinestLevelOptions finest_options(const CityLayout& layout, std::optional<std::int32_t> epoch) {
  return {layout.voxel_sizes.front(), has_channel(layout, "intensity"), has_labels(layout), epoch};
}

VoxelMap finish_tile(const TileId& tile, std::vector<EpochSums> epochs, const CityLayout& layout) {
  const std::vector<SeenVoxel> seen =
      has_channel(layout, "first_epoch") ? seen_voxels(epochs) : std::vector<SeenVoxel>();
  VoxelMap map = map_of_sums(sums_of_all(std::move(epochs)), finest_options(layout, std::nullopt), layout);
  add_epochs(map.levels.front().channels(), seen);
  complete(map, layout.voxel_sizes);
  return in_layout(cut_tile(map, tile), layout);
}

VoxelMap in_layout(VoxelMap map, const CityLayout& layout) {
  map.frame = layout.frame;
  map.has_color = layout.has_color;
  map.label_scheme = layout.label_scheme;
  for (VoxelLevel& level : map.levels) level = with_channels(std::move(level), layout.channels);
  return map;
}

}  // namespace vdbmap
