// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/city_update.h"

#include <algorithm>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/atomic_folder.h"
#include "vdbmap/store/city_base.h"
#include "vdbmap/store/city_writer.h"
#include "vdbmap/store/driven_tiles.h"
#include "vdbmap/store/source_points.h"
#include "vdbmap/store/tile_finish.h"
#include "vdbmap/store/tile_renewal.h"
#include "vdbmap/store/tile_sums.h"

namespace vdbmap {
namespace {

std::filesystem::path made_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw IoError::system(folder, "cannot create", error.value());
  return folder;
}

// The points of the clouds as a city of its own, in a folder that goes when all is done.
City make_drive(const City& city, const CloudSource& clouds, const std::filesystem::path& folder,
                const CityUpdateOptions& options) {
  const CityLayout& layout = city.manifest.layout;
  BuildOptions build;
  build.voxel_sizes = layout.voxel_sizes;
  build.epoch = options.update.epoch;
  TileSums sums(layout.voxel_sizes, made_folder(folder / "points"), bytes_of_sums(options.memory_bytes));
  const PointKinds kinds =
      count_clouds(sums, clouds, layout.frame.anchor, layout.voxel_sizes.front(), options.memory_bytes);
  City drive{folder, std::nullopt, {}};
  drive.manifest.layout = layout_of_points(layout.frame.anchor, kinds, {}, build, layout.density);
  drive.manifest.layout.frame = layout.frame;
  drive.manifest.layout.label_scheme = options.label_scheme(layout.label_scheme);
  const std::filesystem::path tiles = made_folder(tiles_path(folder));
  const SaveTile save = [&](const TileId& id, const VoxelMap& tile, const std::optional<Visibility>& /*seen*/) {
    return save_tile(tiles, id, tile, layout.density);
  };
  drive.manifest.tiles =
      renew_tiles(sums.tiles(), {std::nullopt, drive.manifest.layout, drive.manifest.layout, options.update.epoch,
                                 [&](const TileId& id) { return sums.take(id); }, save});
  return drive;
}

void check_new(const std::vector<MapSource>& sources, const City& city) {
  for (const MapSource& source : sources) {
    const bool is_known = std::ranges::count(city.manifest.sources, source.hash, &MapSource::hash) > 0;
    if (is_known) throw std::invalid_argument(city.folder.string() + ": has counted " + source.name + " already");
  }
}

// What nobody looked at is in all of the city.
void count_unseen(UpdateCounts& counts, const CityManifest& before) {
  counts.unseen = num_voxels(before).front() - counts.confirmed - counts.replaced - counts.gone;
}

// Where the city is made in another folder, what stays is taken over.
void take_over(const CityWriter& writer, const City& base, const std::vector<CityTile>& kept) {
  if (writer.current()) return;
  for (const CityTile& tile : kept) {
    if (find_tile(base.manifest, tile.id) && *find_tile(base.manifest, tile.id) == tile) {
      writer.adopt_tile(tile, base.folder);
    }
  }
}

}  // namespace

std::int32_t epoch_after(const CityManifest& manifest, const std::optional<std::int32_t>& wanted) {
  if (!wanted) return manifest.epoch + 1;
  if (*wanted >= manifest.epoch) return *wanted;
  throw std::invalid_argument("epoch is " + std::to_string(*wanted) + ", but the city is in epoch " +
                              std::to_string(manifest.epoch) + " already");
}

UpdatedCity update_city(const std::filesystem::path& city, const std::filesystem::path& output,
                        const CloudSource& clouds, const std::vector<MapSource>& sources,
                        const CityUpdateOptions& options) {
  options.update.check();
  if (open_city(city).epoch && city == output) {
    throw std::invalid_argument(city.string() + ": is an epoch of a city, only its latest can be brought up to date");
  }
  std::error_code missing;
  const bool is_in_place = std::filesystem::equivalent(city, output, missing);
  CityWriter writer(output);
  if (!is_in_place && writer.current()) throw IoError::malformed(output, "holds a city already");
  const City base = is_in_place ? *writer.current() : open_city(city);
  if (keeps_parts(base.manifest)) {
    throw std::invalid_argument(
        base.folder.string() +
        ": keeps the sums of its sources, which say nothing of rays: update a city built without --keep-parts");
  }
  check_new(sources, base);
  CityUpdateOptions chosen = options;
  chosen.update.epoch = epoch_after(base.manifest, options.update.epoch);

  const AtomicFolder work(writer.folder() / "sums");
  const City drive = make_drive(base, clouds, made_folder(work.temporary_path() / "drive"), chosen);
  RayWindows rays({&base, &drive}, chosen.update.trust, chosen.memory_bytes,
                  made_folder(work.temporary_path() / "rays"));
  clouds([&](const PosedCloud& posed) { rays.add(posed); });
  rays.finish();

  DrivenTiles driven(base, drive, rays, chosen.update);
  chosen.on_tiles_begun(driven.ids().size());
  driven.judge();
  const CityLayout& layout = driven.layout();
  const SaveTile save = [&](const TileId& id, const VoxelMap& tile, const std::optional<Visibility>& seen) {
    return writer.save_tile(id, tile, layout.density, seen);
  };
  std::vector<CityTile> made = driven.make(save, chosen.on_tile_done);
  UpdateCounts counts = driven.counts();
  count_unseen(counts, base.manifest);
  chosen.check(counts);
  std::vector<CityTile> kept = keep_tiles(base, tiles_without(base, driven.ids()), layout, save);
  take_over(writer, base, kept);

  std::vector<MapSource> counted = sources;
  for (MapSource& source : counted) source.epoch = *chosen.update.epoch;
  UpdatedCity updated{{}, counts, made.size()};
  updated.manifest =
      manifest_with(base, std::move(kept), {layout, std::move(made), std::move(counted)}, *chosen.update.epoch);
  add_epoch(updated.manifest.epochs, {*chosen.update.epoch, chosen.date, changes_of(counts)});
  writer.publish(updated.manifest, chosen.keep_epochs);
  return updated;
}

}  // namespace vdbmap
