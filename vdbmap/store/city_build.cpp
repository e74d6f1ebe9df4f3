// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/city_build.h"

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/atomic_folder.h"
#include "vdbmap/store/city_base.h"
#include "vdbmap/store/city_of_parts.h"
#include "vdbmap/store/city_rays.h"
#include "vdbmap/store/city_writer.h"
#include "vdbmap/store/source_changes.h"
#include "vdbmap/store/source_points.h"
#include "vdbmap/store/tile_finish.h"
#include "vdbmap/store/tile_renewal.h"
#include "vdbmap/store/tile_sums.h"

namespace vdbmap {
namespace {

// What rays of the inputs say of the city as the manifest has it, in its tiles.
void add_rays(CityManifest& manifest, const CityWriter& writer, const std::optional<City>& base,
              const std::vector<MapInput>& inputs, const std::filesystem::path& folder,
              const CityBuildOptions& options) {
  std::filesystem::create_directory(folder);
  const SaveTile save = [&](const TileId& id, const VoxelMap& tile, const std::optional<Visibility>& seen) {
    return writer.save_tile(id, tile, manifest.layout.density, seen);
  };
  manifest.tiles = add_rays_to_tiles(
      {writer.folder(), std::nullopt, manifest}, base, [&](const auto& take) { options.rays(inputs, take); },
      options.memory_bytes, folder, save);
}

// Counts the new sources and publishes the city with them.
CityBuilt write_city(CityWriter& writer, const std::optional<City>& base, SourceChanges counted,
                     const CityBuildOptions& options) {
  const AtomicFolder spilled(writer.folder() / "sums");
  TileSums sums(options.files.build.voxel_sizes, spilled.temporary_path(), bytes_of_sums(options.memory_bytes));
  options.on_reading_begun(counted.inputs.size());
  CountedPoints points = count_points(sums, counted.inputs, options.files, options.memory_bytes);
  check_any_point(points.notes);

  const std::int32_t epoch = options.files.build.epoch.value_or(base ? base->manifest.epoch : 0);
  for (std::size_t i = 0; i < counted.sources.size(); ++i) counted.sources[i].num_points = points.num_points[i];
  const CityLayout added =
      layout_of_points(*points.anchor, points.kinds, points.notes, options.files.build, options.save.density);
  const CityLayout layout = base ? merged_layout(base->manifest.layout, added) : added;
  const SaveTile save = [&](const TileId& id, const VoxelMap& tile, const std::optional<Visibility>& seen) {
    return writer.save_tile(id, tile, layout.density, seen);
  };
  const std::vector<TileId> ids = sums.tiles();
  options.on_tiles_begun(ids.size());
  std::vector<CityTile> renewed =
      renew_tiles(ids, {base, added, layout, options.files.build.epoch, [&](const TileId& id) { return sums.take(id); },
                        save, options.on_tile_done});
  std::vector<CityTile> kept;
  if (base) kept = keep_tiles(*base, tiles_without(*base, ids), layout, save);
  CityBuilt built{manifest_with(base, std::move(kept), {layout, std::move(renewed), counted.sources}, epoch),
                  std::move(points.notes),
                  counted.sources,
                  counted.not_counted,
                  {},
                  {}};
  if (!options.date.empty()) add_epoch(built.manifest.epochs, {epoch, options.date, {}});
  if (options.rays) add_rays(built.manifest, writer, base, counted.inputs, spilled.temporary_path() / "rays", options);
  writer.publish(built.manifest, options.keep_epochs);
  return built;
}

// Tiles that are made of parts alone would lose what rays saw.
void check_rays_without_parts(bool keeps_parts, const CityBuildOptions& options) {
  if (keeps_parts && options.rays) throw std::invalid_argument("a city that keeps parts keeps no rays yet");
}

// Nothing of a city without parts can be taken out exactly: its tiles hold rounded means of all sources.
void check_kept_parts(const City& base, const CityBuildOptions& options) {
  if (keeps_parts(base.manifest)) return;
  const std::string reason = base.folder.string() + ": does not keep the sums of its sources, so ";
  if (!options.removed.empty() || !options.replaced.empty()) {
    throw std::invalid_argument(reason + "none can be taken out: build it anew with --keep-parts");
  }
  if (options.keeps_parts) throw std::invalid_argument(reason + "those of new ones are of no use: build it anew");
}

}  // namespace

CityBuilt build_city(const std::filesystem::path& folder, const std::vector<MapInput>& inputs,
                     const CityBuildOptions& options) {
  options.files.build.check();
  check_rays_without_parts(options.keeps_parts, options);
  CityWriter writer(folder);
  SourceChanges changes = find_changes(std::nullopt, inputs, options);
  if (writer.current()) check_replaceable(*writer.current(), writer.num_epochs(), changes.sources);
  if (options.keeps_parts) return write_city_of_parts(writer, std::nullopt, std::move(changes), options);
  return write_city(writer, std::nullopt, std::move(changes), options);
}

CityBuilt add_to_city(const std::filesystem::path& folder, const std::vector<MapInput>& inputs,
                      const CityBuildOptions& options) {
  options.files.build.check();
  if (open_city(folder).epoch) {  // and is no new folder
    throw std::invalid_argument(folder.string() + ": is an epoch of a city, only its latest can be added to");
  }
  CityWriter writer(folder);
  const std::optional<City> base = writer.current();
  CityBuildOptions fitting = options;
  fit_to_city(*base, fitting.files, fitting.save);
  check_kept_parts(*base, options);
  check_rays_without_parts(keeps_parts(base->manifest), options);
  SourceChanges changes = find_changes(base, inputs, fitting);
  if (changes.empty()) {
    return {base->manifest, {}, {}, std::move(changes.not_counted), {}, std::move(changes.not_found)};
  }
  try {
    return keeps_parts(base->manifest) ? write_city_of_parts(writer, base, std::move(changes), fitting)
                                       : write_city(writer, base, std::move(changes), fitting);
  } catch (const std::invalid_argument& error) {
    throw IoError::malformed(folder, error.what());
  }
}

}  // namespace vdbmap
