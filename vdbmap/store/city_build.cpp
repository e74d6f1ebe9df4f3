// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/city_build.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/atomic_folder.h"
#include "vdbmap/store/city_base.h"
#include "vdbmap/store/city_rays.h"
#include "vdbmap/store/city_writer.h"
#include "vdbmap/store/source_hash.h"
#include "vdbmap/store/source_points.h"
#include "vdbmap/store/tile_finish.h"
#include "vdbmap/store/tile_renewal.h"
#include "vdbmap/store/tile_sums.h"

namespace vdbmap {
namespace {

// Inputs and what tells them apart, in the order in which they are counted.
struct NewSources {
  std::vector<MapInput> inputs;
  std::vector<MapSource> sources;
  std::vector<std::string> not_counted;
};

NewSources sort_sources(const std::vector<MapInput>& inputs, const std::vector<MapSource>& sources,
                        const std::vector<MapSource>& known) {
  std::vector<std::size_t> order(inputs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return std::tie(sources[i].name, sources[i].hash); });
  std::set<std::string> counted;
  for (const MapSource& source : known) counted.insert(source.hash);
  NewSources result;
  for (const std::size_t i : order) {
    if (!counted.insert(sources[i].hash).second) {
      result.not_counted.push_back(sources[i].name);
      continue;
    }
    result.inputs.push_back(inputs[i]);
    result.sources.push_back(sources[i]);
  }
  return result;
}

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
CityBuilt write_city(CityWriter& writer, const std::optional<City>& base, NewSources counted,
                     const CityBuildOptions& options) {
  const AtomicFolder spilled(writer.folder() / "sums");
  TileSums sums(options.files.build.voxel_sizes, spilled.temporary_path(), bytes_of_sums(options.memory_bytes));
  options.on_reading_begun(counted.inputs.size());
  CountedPoints points = count_points(sums, counted.inputs, options.files, options.memory_bytes);
  check_any_point(points.notes);

  const std::int32_t epoch = options.files.build.epoch.value_or(base ? base->manifest.epoch : 0);
  for (std::size_t i = 0; i < counted.sources.size(); ++i) {
    counted.sources[i].num_points = points.num_points[i];
    counted.sources[i].epoch = epoch;
  }
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
                  std::move(points.notes), std::move(counted.sources), std::move(counted.not_counted)};
  if (!options.date.empty()) add_epoch(built.manifest.epochs, {epoch, options.date, {}});
  if (options.rays) add_rays(built.manifest, writer, base, counted.inputs, spilled.temporary_path() / "rays", options);
  writer.publish(built.manifest, options.keep_epochs);
  return built;
}

}  // namespace

CityBuilt build_city(const std::filesystem::path& folder, const std::vector<MapInput>& inputs,
                     const CityBuildOptions& options) {
  options.files.build.check();
  CityWriter writer(folder);
  NewSources counted = sort_sources(inputs, identify_sources(inputs, options.on_file_hashed), {});
  if (writer.current()) check_replaceable(*writer.current(), writer.num_epochs(), counted.sources);
  return write_city(writer, std::nullopt, std::move(counted), options);
}

CityBuilt add_to_city(const std::filesystem::path& folder, const std::vector<MapInput>& inputs,
                      const CityBuildOptions& options) {
  options.files.build.check();
  open_city(folder);  // is no new folder
  CityWriter writer(folder);
  const std::optional<City> base = writer.current();
  CityBuildOptions fitting = options;
  fit_to_city(*base, fitting.files, fitting.save);
  NewSources counted = sort_sources(inputs, identify_sources(inputs, options.on_file_hashed), base->manifest.sources);
  if (counted.inputs.empty()) return {base->manifest, {}, {}, std::move(counted.not_counted)};
  try {
    return write_city(writer, base, std::move(counted), fitting);
  } catch (const std::invalid_argument& error) {
    throw IoError::malformed(folder, error.what());
  }
}

}  // namespace vdbmap
