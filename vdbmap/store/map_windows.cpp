// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/map_windows.h"

#include <algorithm>
#include <cstddef>
#include <list>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "vdbmap/core/error.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/core/parallel_tasks.h"

namespace vdbmap {
namespace {

constexpr std::size_t kLeastWindows = 2;  // that are kept

}  // namespace

struct MapWindows::CityWindows {
  struct KeptWindow {
    std::vector<std::size_t> tiles;  // numbers, rising
    std::shared_ptr<const VoxelMap> map;
  };

  City city;
  std::size_t kept_bytes;
  std::vector<CityTile> tiles;  // the chosen ones
  std::mutex mutex;
  std::optional<VoxelMap> overview;
  std::list<KeptWindow> kept;  // the last used first

  CityWindows(City opened, const TileChoice& is_wanted, std::size_t bytes)
      : city(std::move(opened)), kept_bytes(bytes) {
    // Tiles that rays alone entered have nothing to look at.
    std::ranges::copy_if(city.manifest.tiles, std::back_inserter(tiles),
                         [&](const CityTile& tile) { return tile.num_voxels.front() > 0 && is_wanted(tile); });
  }

  bool is_chosen(const CityTile& tile) const { return std::ranges::find(tiles, tile) != tiles.end(); }
  std::vector<std::size_t> tiles_around(const Eigen::Vector3d& place, double radius) const;
  VoxelMap tile(std::size_t number) const;
  VoxelMap load(const std::vector<std::size_t>& numbers) const;
  void forget();
};

std::vector<std::size_t> MapWindows::CityWindows::tiles_around(const Eigen::Vector3d& place, double radius) const {
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(radius);
  const TileChoice is_near = tiles_in_box({place - reach, place + reach});
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    if (is_near(tiles[i])) numbers.push_back(i);
  }
  return numbers;
}

// From a window that has it, or from its file.
VoxelMap MapWindows::CityWindows::tile(std::size_t number) const {
  for (const KeptWindow& window : kept) {
    if (std::ranges::binary_search(window.tiles, number)) return cut_tile(*window.map, tiles[number].id);
  }
  std::optional<VoxelMap> loaded = load_tile(city, tiles[number]);
  if (!loaded) throw IoError::malformed(city.folder, "was changed while it was read");
  return std::move(*loaded);
}

VoxelMap MapWindows::CityWindows::load(const std::vector<std::size_t>& numbers) const {
  std::vector<std::optional<VoxelMap>> loaded(numbers.size());
  parallel_tasks(numbers.size(), [&](std::size_t i) { loaded[i] = tile(numbers[i]); });
  std::vector<VoxelMap> parts;
  for (std::optional<VoxelMap>& part : loaded) parts.push_back(std::move(*part));
  if (parts.empty()) return empty_map(city.manifest.layout.frame, city.manifest.layout.voxel_sizes);
  return parts.size() == 1 ? std::move(parts.front()) : splice(parts);
}

void MapWindows::CityWindows::forget() {
  std::size_t count = 0;
  std::size_t bytes = 0;
  kept.remove_if([&](const KeptWindow& window) {
    bytes += memory_bytes(*window.map);
    return ++count > kLeastWindows && bytes > kept_bytes;
  });
}

MapWindows::MapWindows(const VoxelMap& map) : whole_(std::shared_ptr<const VoxelMap>(), &map) {}

MapWindows::MapWindows(VoxelMap&& map) : whole_(std::make_shared<const VoxelMap>(std::move(map))) {}

MapWindows::MapWindows(City city, const TileChoice& is_wanted, std::size_t kept_bytes)
    : city_(std::make_shared<CityWindows>(std::move(city), is_wanted, kept_bytes)) {}

const City* MapWindows::city() const { return city_ ? &city_->city : nullptr; }

std::span<const CityTile> MapWindows::tiles() const {
  return city_ ? std::span<const CityTile>(city_->tiles) : std::span<const CityTile>();
}

std::vector<double> MapWindows::voxel_sizes() const {
  if (city_) return city_->city.manifest.layout.voxel_sizes;
  std::vector<double> sizes;
  for (const VoxelLevel& level : whole_->levels) sizes.push_back(level.voxel_size());
  return sizes;
}

const VoxelMap& MapWindows::overview() const {
  if (whole_) return *whole_;
  const std::scoped_lock lock(city_->mutex);
  if (!city_->overview) {
    const CityManifest before = city_->city.manifest;
    const auto load = [&] {
      return load_coarser_window(city_->city, [&](const CityTile& tile) { return city_->is_chosen(tile); });
    };
    city_->overview = isolated(load);
    if (city_->city.manifest != before) throw IoError::malformed(city_->city.folder, "was changed while it was read");
  }
  return *city_->overview;
}

std::shared_ptr<const VoxelMap> MapWindows::around(const Eigen::Vector3d& place, double radius) const {
  if (whole_) return whole_;
  std::vector<std::size_t> tiles = city_->tiles_around(place, radius);
  const std::scoped_lock lock(city_->mutex);
  std::list<CityWindows::KeptWindow>& kept = city_->kept;
  const auto known = std::ranges::find(kept, tiles, &CityWindows::KeptWindow::tiles);
  if (known != kept.end()) {
    kept.splice(kept.begin(), kept, known);
  } else {
    auto map = std::make_shared<const VoxelMap>(isolated([&] { return city_->load(tiles); }));
    kept.push_front({std::move(tiles), std::move(map)});
    city_->forget();
  }
  return kept.front().map;
}

}  // namespace vdbmap
