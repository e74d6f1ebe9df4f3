// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/ray_windows.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vdbmap/core/map_tiles.h"
#include "vdbmap/core/parallel_tasks.h"
#include "vdbmap/core/point_cell.h"
#include "vdbmap/store/city_window.h"
#include "vdbmap/store/tile_visibility.h"

namespace vdbmap {
namespace {

constexpr std::size_t kLeastRays = std::size_t{1} << 16;
constexpr std::size_t kBytesOfRay = sizeof(MeasuredRay) + sizeof(VoxelIndex);
constexpr std::size_t kBytesOfVoxel = 250;                   // record, surface and what is counted, loading included
constexpr std::size_t kBytesOfTile = std::size_t{16} << 20;  // of the space above a street, seen leaf by leaf

// The tiles of a row or column from one coordinate [m] to another.
std::pair<std::int32_t, std::int32_t> tiles_between(double a, double b, double tolerance) {
  return {static_cast<std::int32_t>(std::floor((std::min(a, b) - tolerance) / kTileSize)),
          static_cast<std::int32_t>(std::floor((std::max(a, b) + tolerance) / kTileSize))};
}

// The tiles near a segment in plan, column by column.
void add_tiles_near(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double tolerance, std::set<TileId>& tiles) {
  const auto [first, last] = tiles_between(from.x(), to.x(), tolerance);
  const Eigen::Vector2d way = to - from;
  for (std::int32_t x = first; x <= last; ++x) {
    double begin = 0, end = 1;  // shares of the way in this column
    if (std::abs(way.x()) > tolerance) {
      const double low = (x * kTileSize - tolerance - from.x()) / way.x();
      const double high = ((x + 1) * kTileSize + tolerance - from.x()) / way.x();
      begin = std::clamp(std::min(low, high), 0.0, 1.0);
      end = std::clamp(std::max(low, high), 0.0, 1.0);
    }
    const auto [low, high] = tiles_between(from.y() + begin * way.y(), from.y() + end * way.y(), tolerance);
    for (std::int32_t y = low; y <= high; ++y) tiles.insert({x, y});
  }
}

VoxelMap window_of(const City& city, const std::set<TileId>& tiles) {
  City opened = city;
  return load_window(opened, [&](const CityTile& tile) { return tiles.contains(tile.id); });
}

template <typename Value>
void append(const VoxelLeaf& leaf, const std::vector<Value>& from, std::vector<Value>& to) {
  const auto begin = from.begin() + static_cast<std::ptrdiff_t>(leaf.transientData());
  to.insert(to.end(), begin, begin + leaf.getValueMask().countOn());
}

template <typename Value>
bool has_any(const VoxelLeaf& leaf, const std::vector<Value>& values) {
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(leaf.transientData());
  return std::any_of(begin, begin + leaf.getValueMask().countOn(), [](TimeBins bins) { return bins.bits() != 0; });
}

// Leaves of a tree, tile by tile.
std::map<TileId, LargeVector<VoxelLeaf>> leaves_by_tile(const VoxelTree& tree, std::int32_t per_tile) {
  std::map<TileId, LargeVector<VoxelLeaf>> leaves;
  for (const VoxelLeaf& leaf : tree.leaves()) leaves[tile_of_leaf(leaf, per_tile)].push_back(leaf);
  return leaves;
}

}  // namespace

void add_tiles_of_ray(const MeasuredRay& ray, double max_range, double tolerance, std::set<TileId>& tiles) {
  const double length = (ray.end - ray.origin).norm();
  const double share = length > max_range ? max_range / length : 1;
  const Eigen::Vector3d stop = ray.origin + share * (ray.end - ray.origin);
  add_tiles_near(ray.origin.head<2>(), stop.head<2>(), tolerance, tiles);
  add_tiles_near(ray.end.head<2>(), ray.end.head<2>(), tolerance, tiles);
}

RayWindows::RayWindows(std::vector<const City*> cities, const RayTrust& trust, std::size_t memory_bytes,
                       const std::filesystem::path& folder)
    : cities_(std::move(cities)),
      trust_(trust),
      voxel_size_(cities_.front()->manifest.layout.voxel_sizes.front()),
      voxels_per_tile_(voxels_per_tile(voxel_size_)),
      // What is in the margin of a voxel decides about it, and rays two voxels from there about that.
      reach_(margin_in_voxels(neighbor_margin(cities_.front()->manifest.layout.voxel_sizes), voxel_size_) +
             static_cast<std::int32_t>(VoxelLeaf::DIM)),
      most_rays_(std::max(memory_bytes / 4 / kBytesOfRay, kLeastRays)),
      window_bytes_(memory_bytes / 2),
      findings_(folder) {}

void RayWindows::add(const PosedCloud& posed) {
  const Eigen::Vector3d& anchor = cities_.front()->manifest.layout.frame.anchor;
  Eigen::Isometry3d local_from_cloud = posed.map_from_cloud;
  local_from_cloud.translation() -= anchor;
  const CellFinder cells(local_from_cloud, voxels_per_metre(voxel_size_));
  const std::vector<MeasuredRay> rays = rays_of(posed, anchor);
  const double per_metre = voxels_per_metre(voxel_size_);
  TileId last;
  Bundle* bundle = nullptr;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::optional<PointCell> cell = cells.find(posed.cloud.positions[i]);
    if (!cell) continue;
    const TileId tile = tile_of_voxel(cell->voxel, voxels_per_tile_);
    if (!bundle || tile != last) bundle = &bundles_[tile];
    last = tile;
    bundle->tiles.insert(tile);
    if (is_addressable(rays[i].origin, per_metre) && is_addressable(rays[i].end, per_metre)) {
      add_tiles_of_ray(rays[i], trust_.max_range, voxel_size_, bundle->tiles);
    }
    bundle->rays.push_back(rays[i]);
    bundle->cells.push_back(cell->voxel);
  }
  num_rays_ += rays.size();
  if (num_rays_ >= most_rays_) follow_all();
}

void RayWindows::finish() { follow_all(); }

void RayWindows::follow_all() {
  std::vector<const Bundle*> together;
  std::set<TileId> tiles;
  std::size_t bytes = 0;
  for (const auto& [end, bundle] : bundles_) {
    std::size_t more = 0;
    for (const TileId& tile : bundle.tiles) more += tiles.contains(tile) ? 0 : bytes_of(tile);
    if (!together.empty() && bytes + more > window_bytes_) {
      follow(together, tiles);
      together.clear();
      tiles.clear();
      bytes = 0;
      more = 0;
      for (const TileId& tile : bundle.tiles) more += bytes_of(tile);
    }
    together.push_back(&bundle);
    tiles.insert(bundle.tiles.begin(), bundle.tiles.end());
    bytes += more;
  }
  if (!together.empty()) follow(together, tiles);
  bundles_.clear();
  num_rays_ = 0;
}

std::size_t RayWindows::bytes_of(const TileId& tile) const {
  std::size_t bytes = kBytesOfTile;
  for (const City* city : cities_) {
    const CityTile* found = find_tile(city->manifest, tile);
    if (found) bytes += kBytesOfVoxel * found->num_voxels.front();
  }
  return bytes;
}

void RayWindows::follow(const std::vector<const Bundle*>& bundles, const std::set<TileId>& tiles) {
  std::vector<VoxelMap> windows;
  for (const City* city : cities_) windows.push_back(window_of(*city, tiles));
  std::vector<const VoxelMap*> maps;
  for (const VoxelMap& window : windows) maps.push_back(&window);
  RayEvidence evidence(maps, trust_);
  const VoxelLevel& last = windows.back().finest();
  std::vector<TimeBins> presence(last.size());
  for (const Bundle* bundle : bundles) {
    evidence.add(bundle->rays);
    parallel_ranges(bundle->rays.size(), 1024, [&](std::size_t begin, std::size_t end) {
      const VoxelFinder finder(last);
      for (std::size_t i = begin; i < end; ++i) {
        const VoxelRecord* record = finder.find(bundle->cells[i]);
        if (!record) continue;
        add_shared(presence[static_cast<std::size_t>(record - last.records().data())],
                   TimeBins::at(bundle->rays[i].time));
      }
    });
  }
  keep(windows, evidence, presence);
}

void RayWindows::keep(const std::vector<VoxelMap>& windows, const RayEvidence& evidence,
                      const std::vector<TimeBins>& presence) {
  std::map<TileId, TileFindings> found;
  const auto at = [&](const TileId& tile) -> TileFindings& {
    TileFindings& findings = found[tile];
    findings.maps.resize(windows.size());
    return findings;
  };
  for (std::size_t map = 0; map < windows.size(); ++map) {
    const bool is_last = map + 1 == windows.size();
    for (const VoxelLeaf& leaf : windows[map].finest().leaves()) {
      TileFindings& findings = at(tile_of_leaf(leaf, voxels_per_tile_));
      append(leaf, evidence.passes(map), findings.maps[map].passes);
      append(leaf, evidence.pass_times(map), findings.maps[map].pass_times);
      if (is_last) append(leaf, presence, findings.presence);
      if (!has_any(leaf, evidence.pass_times(map)) && !(is_last && has_any(leaf, presence))) continue;
      const TileRange near = tiles_around(leaf.origin(), VoxelLeaf::DIM, reach_, voxels_per_tile_);
      for (std::int32_t x = near.low.x; x <= near.high.x; ++x) {
        for (std::int32_t y = near.low.y; y <= near.high.y; ++y) tiles_nearby_.insert({x, y});
      }
    }
  }
  for (auto& [tile, leaves] : leaves_by_tile(evidence.seen_empty(), voxels_per_tile_)) {
    at(tile).seen_empty = VoxelTree(std::move(leaves));
  }
  std::vector<std::pair<TileId, TileFindings>> list(std::make_move_iterator(found.begin()),
                                                    std::make_move_iterator(found.end()));
  for (const auto& [tile, findings] : list) {
    if (findings.is_any()) tiles_.insert(tile);
  }
  parallel_tasks(list.size(), [&](std::size_t i) { findings_.add(list[i].first, std::move(list[i].second)); });
  tiles_nearby_.insert(tiles_.begin(), tiles_.end());
}

}  // namespace vdbmap
