// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/city_of_parts.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <tuple>
#include <utility>

#include "vdbmap/io/file/atomic_folder.h"
#include "vdbmap/store/city_base.h"
#include "vdbmap/store/kept_parts.h"
#include "vdbmap/store/sums_file.h"

namespace vdbmap {
namespace {

// Parts of new sources, saved, and what was found in them.
struct SavedParts {
  std::vector<KeptSource> sources;
  std::optional<Eigen::Vector3d> anchor;
  InputNotes notes;
};

KeptSource save_part(const CityWriter& writer, const MapSource& source, const PartNotes& found, TileSums& sums) {
  const std::vector<TileId> ids = sums.tiles();
  const CityPart part = writer.save_part(found, ids, [&](const TileId& id) { return pack_sums(sums.take(id)); });
  return open_kept_source(writer.folder(), source, part);
}

SavedParts save_parts(const CityWriter& writer, const SourceChanges& changes, const CityBuildOptions& options) {
  const AtomicFolder spilled(writer.folder() / "sums");
  MapFromFilesOptions files = options.files;
  SavedParts saved;
  std::vector<PartNotes> found;
  for (std::size_t i = 0; i < changes.inputs.size(); ++i) {
    TileSums sums(files.build.voxel_sizes, spilled.temporary_path(), bytes_of_sums(options.memory_bytes));
    CountedPoints points = count_points(sums, {changes.inputs[i]}, files, options.memory_bytes);
    files.build.anchor = points.anchor;
    MapSource source = changes.sources[i];
    source.num_points = points.num_points.front();
    found.push_back({source, points.kinds, std::move(points.notes)});
    saved.sources.push_back(save_part(writer, source, to_be_kept(found.back(), files.build.epsg), sums));
  }
  saved.anchor = files.build.anchor;
  std::vector<const PartNotes*> all;
  for (const PartNotes& of_source : found) all.push_back(&of_source);
  saved.notes = common_notes(all).notes;
  if (!found.empty()) check_any_point(saved.notes);
  return saved;
}

// What new tiles have in common with those of the city, or with no others.
CityLayout like_layout(const std::optional<City>& base, const Eigen::Vector3d& anchor,
                       const CityBuildOptions& options) {
  return layout_of_points(anchor, {}, {}, options.files.build,
                          base ? base->manifest.layout.density : options.save.density);
}

// The sources of a city that stay, without those that go.
std::vector<KeptSource> take_removed(std::vector<KeptSource>& sources, const std::vector<MapSource>& removed) {
  std::set<std::string> hashes;
  for (const MapSource& source : removed) hashes.insert(source.hash);
  const auto gone = std::stable_partition(
      sources.begin(), sources.end(), [&](const KeptSource& source) { return !hashes.contains(source.source.hash); });
  std::vector<KeptSource> taken(std::make_move_iterator(gone), std::make_move_iterator(sources.end()));
  sources.erase(gone, sources.end());
  return taken;
}

CityManifest manifest_of(std::vector<CityTile> kept, std::vector<CityTile> made, const CityLayout& layout,
                         const std::vector<KeptSource>& sources, std::int32_t epoch) {
  NewTiles tiles{layout, std::move(made), {}};
  for (const KeptSource& source : sources) tiles.sources.push_back(source.source);
  CityManifest manifest = manifest_with(std::nullopt, std::move(kept), std::move(tiles), epoch);
  for (const KeptSource& source : sources) manifest.parts.push_back(source.kept);
  std::ranges::sort(manifest.parts, {}, &CityPart::source);
  return manifest;
}

}  // namespace

CityBuilt write_city_of_parts(CityWriter& writer, const std::optional<City>& base, SourceChanges changes,
                              const CityBuildOptions& options) {
  std::vector<KeptSource> sources;
  if (base) sources = open_kept_sources(*base);
  const std::vector<KeptSource> removed = take_removed(sources, changes.removed);
  options.on_reading_begun(changes.inputs.size());
  SavedParts added = save_parts(writer, changes, options);
  std::set<TileId> touched = tiles_touched_by(removed);
  touched.merge(tiles_touched_by(added.sources));
  std::ranges::move(added.sources, std::back_inserter(sources));
  std::ranges::sort(sources, {}, [](const KeptSource& s) { return std::tie(s.source.name, s.source.hash); });

  const TilesOfSources tiles(sources, like_layout(base, *added.anchor, options));
  const bool has_other_layout = !base || tiles.layout() != base->manifest.layout;
  std::vector<TileId> ids = tiles.ids();
  std::vector<CityTile> kept;
  if (!has_other_layout) {
    std::erase_if(ids, [&](const TileId& id) { return !touched.contains(id); });
    kept = tiles_without(*base, std::vector<TileId>(touched.begin(), touched.end()));
  }
  options.on_tiles_begun(ids.size());
  std::vector<CityTile> made = tiles.make(
      ids,
      [&](const TileId& id, const VoxelMap& tile, const std::optional<Visibility>& seen) {
        return writer.save_tile(id, tile, tiles.layout().density, seen);
      },
      options.on_tile_done);
  const std::int32_t epoch = options.files.build.epoch.value_or(base ? base->manifest.epoch : 0);
  CityBuilt built{manifest_of(std::move(kept), std::move(made), tiles.layout(), sources, epoch),
                  std::move(added.notes),
                  {},
                  std::move(changes.not_counted),
                  std::move(changes.removed),
                  std::move(changes.not_found)};
  if (base) built.manifest.epochs = base->manifest.epochs;
  if (!options.date.empty()) add_epoch(built.manifest.epochs, {epoch, options.date, {}});
  for (const MapSource& source : changes.sources) {
    const auto counted = std::ranges::find(sources, source.hash, [](const KeptSource& s) { return s.source.hash; });
    built.added.push_back(counted->source);
  }
  writer.publish(built.manifest, options.keep_epochs);
  return built;
}

}  // namespace vdbmap
