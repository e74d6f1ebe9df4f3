// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/kept_parts.h"

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/core/parallel_tasks.h"
#include "vdbmap/store/tile_finish.h"

namespace vdbmap {
namespace {

bool has_epochs(const CityLayout& layout) { return std::ranges::count(layout.channels, "last_epoch") > 0; }

CityLayout layout_of_sources(std::span<const KeptSource> sources, const CityLayout& like) {
  std::vector<const PartNotes*> found;
  for (const KeptSource& source : sources) found.push_back(&source.part.found);
  const CommonNotes common = common_notes(found);
  BuildOptions build;
  build.voxel_sizes = like.voxel_sizes;
  if (has_epochs(like)) build.epoch = 0;  // whichever
  return layout_of_points(like.frame.anchor, common.kinds, common.notes, build, like.density);
}

}  // namespace

KeptSource open_kept_source(const std::filesystem::path& folder, const MapSource& source, const CityPart& part) {
  const std::filesystem::path path = kept_part_path(folder, part);
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error == std::errc::no_such_file_or_directory) {
    throw IoError::malformed(path, "is missing: the sums of " + source.name);
  }
  if (error) throw IoError::system(path, "cannot open", error.value());
  KeptSource kept{source, part, open_part(path, source.name, source.name)};
  const PartNotes& found = kept.part.found;
  if (size != part.num_bytes || kept.part.hash != part.hash || found.source.hash != source.hash ||
      found.source.num_points != source.num_points) {
    throw IoError::malformed(path, "is not the part that its name says: the sums of " + source.name);
  }
  return kept;
}

std::vector<KeptSource> open_kept_sources(const City& city) {
  const std::vector<MapSource>& sources = city.manifest.sources;
  std::vector<std::optional<KeptSource>> opened(sources.size());
  parallel_tasks(sources.size(), [&](std::size_t i) {
    opened[i] = open_kept_source(city.folder, sources[i], *find_part(city.manifest, sources[i].hash));
  });
  std::vector<KeptSource> kept;
  for (std::optional<KeptSource>& source : opened) kept.push_back(std::move(*source));
  return kept;
}

void check_sums(const Part& part) {
  for (const PartTile& tile : part.tiles) {
    VoxelBlocks blocks;
    add_tile_of_part(part, tile, blocks);
  }
}

TilesOfSources::TilesOfSources(std::span<const KeptSource> sources, const CityLayout& like)
    : layout_(layout_of_sources(sources, like)) {
  for (const KeptSource& source : sources) {
    TilesOfParts& places = places_[has_epochs(layout_) ? source.source.epoch : 0];
    for (const PartTile& tile : source.part.tiles) places[tile.id].push_back({&source.part, &tile});
  }
}

std::vector<TileId> TilesOfSources::ids() const {
  std::set<TileId> ids;
  for (const auto& [epoch, places] : places_) {
    for (const auto& [id, in_parts] : places) ids.insert(id);
  }
  return {ids.begin(), ids.end()};
}

VoxelMap TilesOfSources::make(const TileId& id) const {
  std::vector<EpochSums> epochs;
  for (const auto& [epoch, places] : places_) {
    const auto found = places.find(id);
    if (found != places.end()) epochs.push_back({epoch, sums_of(found->second)});
  }
  return finish_tile(id, std::move(epochs), layout_);
}

std::vector<CityTile> TilesOfSources::make(std::span<const TileId> ids, const SaveTile& save,
                                           const std::function<void()>& on_tile_done) const {
  std::vector<std::optional<CityTile>> saved(ids.size());
  // In batches: a thread that waits for others within a tile would else begin another.
  for (std::size_t begin = 0; begin < ids.size(); begin += num_threads()) {
    parallel_tasks(std::min(num_threads(), ids.size() - begin), [&](std::size_t i) {
      const TileId& id = ids[begin + i];
      const VoxelMap tile = make(id);
      if (tile.finest().size() > 0) saved[begin + i] = save(id, tile, std::nullopt);
      on_tile_done();
    });
  }
  std::vector<CityTile> tiles;
  for (std::optional<CityTile>& tile : saved) {
    if (tile) tiles.push_back(std::move(*tile));
  }
  return tiles;
}

std::set<TileId> tiles_touched_by(std::span<const KeptSource> sources) {
  std::set<TileId> ids;
  for (const KeptSource& source : sources) {
    for (const PartTile& tile : source.part.tiles) ids.insert(tile.id);
  }
  return ids;
}

}  // namespace vdbmap
