// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/city_base.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

namespace vdbmap {
namespace {

void check_epoch(const std::optional<std::int32_t>& epoch, const City& city) {
  if (epoch.value_or(city.manifest.epoch) >= city.manifest.epoch) return;
  throw std::invalid_argument("epoch is " + std::to_string(*epoch) + ", but " + city.folder.string() + " is in epoch " +
                              std::to_string(city.manifest.epoch) + " already");
}

void check_levels(const std::vector<double>& voxel_sizes, const City& city) {
  if (exact_voxel_sizes(voxel_sizes) == city.manifest.layout.voxel_sizes) return;
  throw std::invalid_argument(city.folder.string() + ": has other levels than those to be added");
}

}  // namespace

void fit_to_city(const City& city, MapFromFilesOptions& files, SaveOptions& save) {
  const CityLayout& layout = city.manifest.layout;
  check_epoch(files.build.epoch, city);
  check_levels(files.build.voxel_sizes, city);
  const bool has_epochs = std::ranges::count(layout.channels, "last_epoch") > 0;
  if (has_epochs && !files.build.epoch) files.build.epoch = city.manifest.epoch;
  files.build.anchor = layout.frame.anchor;
  save.density = layout.density;
}

void check_replaceable(const City& city, std::size_t num_epochs, const std::vector<MapSource>& sources) {
  const std::vector<MapSource>& known = city.manifest.sources;
  const auto is_given = [&](const MapSource& source) {
    return std::ranges::count(sources, source.hash, &MapSource::hash) > 0;
  };
  if (num_epochs == 1 && !known.empty() && std::ranges::all_of(known, is_given)) return;
  throw std::invalid_argument(city.folder.string() +
                              ": is a city of other sources or of several epochs, choose another output or add to it");
}

CityManifest manifest_with(const std::optional<City>& base, std::vector<CityTile> kept, NewTiles added,
                           std::int32_t epoch) {
  CityManifest manifest = base ? base->manifest : CityManifest();
  manifest.epoch = epoch;
  manifest.layout = std::move(added.layout);
  manifest.tiles = std::move(kept);
  manifest.tiles.insert(manifest.tiles.end(), added.tiles.begin(), added.tiles.end());
  manifest.sources.insert(manifest.sources.end(), added.sources.begin(), added.sources.end());
  std::ranges::sort(manifest.tiles, {}, &CityTile::id);
  std::ranges::sort(manifest.sources, {}, [](const MapSource& s) { return std::tie(s.epoch, s.name, s.hash); });
  return manifest;
}

std::vector<CityTile> tiles_without(const City& base, std::span<const TileId> renewed) {
  std::vector<CityTile> tiles;
  for (const CityTile& tile : base.manifest.tiles) {
    if (!std::ranges::binary_search(renewed, tile.id)) tiles.push_back(tile);
  }
  return tiles;
}

}  // namespace vdbmap
