// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/coarse/level_features.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "vdbmap/core/map_tiles.h"
#include "vdbmap/core/parallel_tasks.h"
#include "vdbmap/store/tile_cache.h"

namespace vdbmap::registration {
namespace {

// Numbers [begin, end) of records.
struct Records {
  std::size_t begin;
  std::size_t end;
};
using TileRecords = std::map<TileId, std::vector<Records>>;

// The records of each tile, in the order of the tile's own tree.
TileRecords records_by_tile(const VoxelLevel& level) {
  const std::int32_t per_tile = voxels_per_tile(level.voxel_size());
  TileRecords records;
  for (const VoxelLeaf& leaf : level.leaves()) {
    const auto begin = static_cast<std::size_t>(leaf.transientData());
    records[tile_of_voxel(leaf.origin(), per_tile)].push_back({begin, begin + leaf.getValueMask().countOn()});
  }
  return records;
}

std::size_t count_of(const std::vector<Records>& records) {
  std::size_t count = 0;
  for (const Records& some : records) count += some.end - some.begin;
  return count;
}

// What is kept of a voxel: the rest is quickly computed.
struct KeptVoxel {
  float side = 1;  // -1 where the normal that its covariance gives is turned round
  std::array<float, kFpfhBins> feature{};
};

std::string bytes_of(const std::vector<KeptVoxel>& voxels) {
  return {reinterpret_cast<const char*>(voxels.data()), voxels.size() * sizeof(KeptVoxel)};
}

std::optional<std::vector<KeptVoxel>> voxels_of(const std::optional<std::string>& bytes, std::size_t count) {
  if (!bytes || bytes->size() != count * sizeof(KeptVoxel)) return std::nullopt;
  std::vector<KeptVoxel> voxels(count);
  std::memcpy(voxels.data(), bytes->data(), bytes->size());
  return voxels;
}

void set_voxels(const std::vector<Records>& records, const std::vector<KeptVoxel>& voxels, LevelFeatures& made) {
  std::size_t next = 0;
  for (const Records& some : records) {
    for (std::size_t i = some.begin; i < some.end; ++i, ++next) {
      if (voxels[next].side < 0) made.points.normals[i] = -made.points.normals[i];
      std::ranges::copy(voxels[next].feature, made.features.col(static_cast<Eigen::Index>(i)).data());
    }
  }
}

// Of the tile's voxels among those of the level `part`, of which `unturned` are the normals as its covariances give
// them.
std::vector<KeptVoxel> voxels_in(const std::vector<Records>& records, const LevelFeatures& part,
                                 const SurfacePoints& unturned) {
  std::vector<KeptVoxel> voxels;
  for (const Records& some : records) {
    for (std::size_t i = some.begin; i < some.end; ++i) {
      KeptVoxel& voxel = voxels.emplace_back();
      voxel.side = part.points.normals[i].dot(unturned.normals[i]) < 0 ? -1 : 1;
      std::copy_n(part.features.col(static_cast<Eigen::Index>(i)).data(), kFpfhBins, voxel.feature.begin());
    }
  }
  return voxels;
}

// The level in some tiles and those around them.
VoxelLevel around_tiles(const VoxelLevel& level, const MapFrame& frame, const std::set<TileId>& tiles) {
  VoxelMap map;
  map.frame = frame;
  map.levels = {level};
  std::vector<VoxelMap> parts;
  for_each_tile(map, [&](const TileId& id, const VoxelMap& part) {
    bool is_near = false;
    for (int i = 0; i < 9; ++i) is_near |= tiles.contains({id.x + i / 3 - 1, id.y + i % 3 - 1});
    if (is_near) parts.push_back(part);
  });
  return std::move(splice(parts).levels.front());
}

// Raised where features are computed otherwise: what was kept before is then not used.
constexpr std::uint64_t kVersion = 1;

std::uint64_t key_of(std::uint64_t neighborhood, const FeatureReach& reach) {
  const auto quanta = [](double metres) { return static_cast<std::uint64_t>(metres * 1e6); };
  return neighborhood ^ (kVersion * 0x165667B19E3779F9u) ^ (quanta(reach.orientation_radius) * 0x9E3779B97F4A7C15u) ^
         (quanta(reach.feature_radius) * 0xC2B2AE3D27D4EB4Fu);
}

// Whether the surroundings of a voxel lie in its tile and the eight around that.
bool is_within_neighbors(const FeatureReach& reach) {
  return reach.orientation_radius + 2 * reach.feature_radius < kTileSize;
}

LevelFeatures features_of_city(const City& city, std::span<const CityTile> tiles, const VoxelLevel& level,
                               const FeatureReach& reach) {
  const TileCache cache(city.folder, "features");
  const TileRecords records = records_by_tile(level);
  LevelFeatures made{fitted_points(level), FpfhMatrix(kFpfhBins, static_cast<Eigen::Index>(level.size()))};
  std::vector<std::optional<std::uint64_t>> keys(tiles.size());
  std::vector<std::uint8_t> is_kept(tiles.size());
  parallel_tasks(tiles.size(), [&](std::size_t i) {
    const std::vector<Records>& own = records.at(tiles[i].id);
    const std::optional<std::uint64_t> neighborhood = neighborhood_hash(city.manifest, tiles, tiles[i]);
    if (neighborhood) keys[i] = key_of(*neighborhood, reach);
    const auto voxels = keys[i] ? voxels_of(cache.read(tiles[i], *keys[i]), count_of(own)) : std::nullopt;
    is_kept[i] = voxels ? 1 : 0;
    if (voxels) set_voxels(own, *voxels, made);
  });

  std::set<TileId> missing;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    if (!is_kept[i]) missing.insert(tiles[i].id);
  }
  if (missing.empty()) return made;
  const VoxelLevel part = around_tiles(level, city.manifest.layout.frame, missing);
  const LevelFeatures of_part = features_of_level(part, reach);
  const SurfacePoints unturned = fitted_points(part);
  const TileRecords part_records = records_by_tile(part);
  parallel_tasks(tiles.size(), [&](std::size_t i) {
    if (is_kept[i]) return;
    const std::vector<KeptVoxel> voxels = voxels_in(part_records.at(tiles[i].id), of_part, unturned);
    set_voxels(records.at(tiles[i].id), voxels, made);
    if (keys[i]) cache.write(tiles[i], *keys[i], bytes_of(voxels));
  });
  return made;
}

}  // namespace

LevelFeatures features_of_level(const VoxelLevel& level, const FeatureReach& reach) {
  LevelFeatures made{surface_points(level, reach.orientation_radius), {}};
  made.features = fpfh_features(level, made.points, reach.feature_radius);
  return made;
}

LevelFeatures features_of_map(const MapWindows& map, const FeatureReach& reach) {
  const VoxelLevel& level = map.overview().coarsest();
  if (!map.city() || !is_within_neighbors(reach)) return features_of_level(level, reach);
  return features_of_city(*map.city(), map.tiles(), level, reach);
}

}  // namespace vdbmap::registration
