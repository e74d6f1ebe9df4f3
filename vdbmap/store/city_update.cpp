// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/city_update.h"

#include <algorithm>
#include <set>
#include <span>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/core/parallel_tasks.h"
#include "vdbmap/io/file/atomic_folder.h"
#include "vdbmap/store/city_base.h"
#include "vdbmap/store/city_window.h"
#include "vdbmap/store/city_writer.h"
#include "vdbmap/store/ray_windows.h"
#include "vdbmap/store/source_points.h"
#include "vdbmap/store/tile_finish.h"
#include "vdbmap/store/tile_groups.h"
#include "vdbmap/store/tile_renewal.h"
#include "vdbmap/store/tile_sums.h"
#include "vdbmap/store/tile_visibility.h"

namespace vdbmap {
namespace {

enum Side : std::size_t { kMap, kDrive };  // of findings

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

// The layout of the city with the drive in it.
CityLayout layout_after(const City& city, const City& drive) {
  CityLayout layout = merged_layout(city.manifest.layout, drive.manifest.layout);
  const LabelScheme known = city.manifest.layout.label_scheme;
  layout.label_scheme = known == LabelScheme::kUnknown ? drive.manifest.layout.label_scheme : known;
  return layout;
}

openvdb::CoordBBox box_of_tile(const TileId& id, double voxel_size) {
  const std::int32_t per_tile = voxels_per_tile(voxel_size);
  openvdb::CoordBBox box = openvdb::CoordBBox::inf();
  box.min().x() = id.x * per_tile;
  box.min().y() = id.y * per_tile;
  box.max().x() = (id.x + 1) * per_tile - 1;
  box.max().y() = (id.y + 1) * per_tile - 1;
  return box;
}

// Values of tiles, one a record, in the order of the records of a window of them; 0 where a tile has none.
// `values_of(tile)` returns a pointer to those of a tile, or nullptr.
template <typename Value, typename ValuesOf>
std::vector<Value> values_in(const VoxelLevel& window, const TileNeighborhood& tiles, const ValuesOf& values_of) {
  const std::int32_t per_tile = voxels_per_tile(window.voxel_size());
  std::vector<Value> values(window.size());
  for (const VoxelLeaf& leaf : window.leaves()) {
    const TileId id = tile_of_leaf(leaf, per_tile);
    const std::vector<Value>* known = values_of(id);
    if (!known || known->empty()) continue;
    const VoxelLeaf* source = tiles.tile(id)->finest().tree().find_leaf(leaf.origin());
    std::copy_n(known->begin() + static_cast<std::ptrdiff_t>(source->transientData()), leaf.getValueMask().countOn(),
                values.begin() + static_cast<std::ptrdiff_t>(leaf.transientData()));
  }
  return values;
}

// Those of one tile's records of values in the order of the records of a window.
template <typename Value>
std::vector<Value> values_of_tile(const VoxelLevel& window, const TileId& id, const std::vector<Value>& values) {
  const std::int32_t per_tile = voxels_per_tile(window.voxel_size());
  std::vector<Value> of_tile;
  for (const VoxelLeaf& leaf : window.leaves()) {
    if (tile_of_leaf(leaf, per_tile) != id) continue;
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(leaf.transientData());
    of_tile.insert(of_tile.end(), begin, begin + leaf.getValueMask().countOn());
  }
  return of_tile;
}

/// The tiles of a city that a drive changes: judged first, as groups of voxels go over borders, then made anew.
class DrivenTiles {
 public:
  DrivenTiles(const City& city, const City& drive, const RayWindows& rays, const CityUpdateOptions& options)
      : drive_city_(drive),
        cities_{city, drive},
        findings_(rays.findings()),
        options_(options),
        layout_(layout_after(city, drive)),
        margin_(neighbor_margin(city.manifest.layout.voxel_sizes)),
        gone_(options.update.gone),
        moved_(options.update.moved) {
    for (const TileId& id : rays.tiles_nearby()) {
      if (rays.tiles().contains(id) || find_tile(city.manifest, id)) ids_.push_back(id);
    }
  }

  const CityLayout& layout() const { return layout_; }
  const std::vector<TileId>& ids() const { return ids_; }
  const UpdateCounts& counts() const { return counts_; }

  /// Which voxels are gone, and which held something that moved.
  void judge() {
    in_batches([&](std::span<const TileId> batch, const Neighborhoods& near) {
      std::vector<Graded> graded(batch.size());
      parallel_tasks(batch.size(), [&](std::size_t i) { graded[i] = grade(batch[i], near); });
      for (std::size_t i = 0; i < batch.size(); ++i) {
        if (const VoxelMap* map = near.map.tile(batch[i])) gone_.add(batch[i], map->finest(), graded[i].map);
        if (const VoxelMap* drive = near.drive.tile(batch[i])) moved_.add(batch[i], drive->finest(), graded[i].drive);
      }
    });
  }

  /// Makes the tiles anew, those without a voxel of which nothing is known left out.
  std::vector<CityTile> make(const SaveTile& save) {
    std::vector<CityTile> tiles;
    in_batches([&](std::span<const TileId> batch, const Neighborhoods& near) {
      std::vector<std::optional<CityTile>> made(batch.size());
      std::vector<UpdateCounts> counts(batch.size());
      parallel_tasks(batch.size(), [&](std::size_t i) {
        made[i] = make_tile(batch[i], near, counts[i], save);
        options_.on_tile_done();
      });
      for (std::size_t i = 0; i < batch.size(); ++i) {
        if (made[i]) tiles.push_back(std::move(*made[i]));
        counts_ = counts_ + counts[i];
      }
    });
    return tiles;
  }

 private:
  // Tiles that are loaded of both.
  struct Neighborhoods {
    TileNeighborhood map;
    TileNeighborhood drive;
  };

  // Grades of a tile's own voxels.
  struct Graded {
    std::vector<SeenGrade> map;
    std::vector<SeenGrade> drive;
  };

  // A tile and its margin.
  struct Windows {
    VoxelMap map;
    VoxelMap drive;
  };

  template <typename Body>
  void in_batches(const Body& body) const {
    Neighborhoods near{TileNeighborhood(cities_[kMap]), TileNeighborhood(cities_[kDrive])};
    const std::size_t batch_size = num_threads();
    for (std::size_t begin = 0; begin < ids_.size(); begin += batch_size) {
      const std::span batch = std::span(ids_).subspan(begin, std::min(batch_size, ids_.size() - begin));
      near.map.load_around(batch);
      near.drive.load_around(batch);
      body(batch, near);
    }
  }

  Windows windows_of(const TileId& id, const Neighborhoods& near) const {
    const auto window = [&](const TileNeighborhood& tiles, const CityLayout& layout) {
      VoxelMap map = tiles.window(id, margin_).value_or(empty_map(layout.frame, layout.voxel_sizes));
      map.frame = layout_.frame;
      map.has_color = layout.has_color;
      map.label_scheme = layout_.label_scheme;
      return map;
    };
    return {window(near.map, cities_[kMap]->manifest.layout), window(near.drive, drive_city_.manifest.layout)};
  }

  Graded grade(const TileId& id, const Neighborhoods& near) const {
    const Windows windows = windows_of(id, near);
    std::map<TileId, std::optional<TileFindings>> found;
    const auto findings_of = [&](const TileId& tile) -> const TileFindings* {
      const auto [place, is_new] = found.try_emplace(tile);
      if (is_new) place->second = findings_.read(tile);
      return place->second ? &*place->second : nullptr;
    };
    const auto values = [&]<typename Value>(const VoxelMap& window, const TileNeighborhood& tiles, const auto& of) {
      return values_in<Value>(window.finest(), tiles, [&](const TileId& tile) -> const std::vector<Value>* {
        const TileFindings* findings = findings_of(tile);
        return findings ? &of(*findings) : nullptr;
      });
    };
    const VoxelLevel& drive = windows.drive.finest();
    const auto presence = values.template operator()<TimeBins>(
        windows.drive, near.drive, [](const TileFindings& findings) -> const auto& { return findings.presence; });
    const auto grades = [&](Side side, const VoxelMap& window, const TileNeighborhood& tiles,
                            const SeenThroughOptions& options) {
      const auto passes = values.template operator()<std::uint32_t>(
          window, tiles, [&](const TileFindings& findings) -> const auto& { return findings.maps[side].passes; });
      const auto times = values.template operator()<TimeBins>(
          window, tiles, [&](const TileFindings& findings) -> const auto& { return findings.maps[side].pass_times; });
      return values_of_tile(window.finest(), id,
                            grade_seen_through(window.finest(), passes, times, drive, presence, options));
    };
    return {grades(kMap, windows.map, near.map, options_.update.gone),
            grades(kDrive, windows.drive, near.drive, options_.update.moved)};
  }

  // Of the records of a window, which were seen through.
  static std::vector<std::uint8_t> seen_through(const VoxelMap& window, const TileNeighborhood& tiles,
                                                const TileGroups& groups) {
    std::map<TileId, std::vector<std::uint8_t>> known;
    return values_in<std::uint8_t>(window.finest(), tiles, [&](const TileId& tile) {
      const auto [place, is_new] = known.try_emplace(tile);
      if (is_new) place->second = groups.seen_through(tile, tiles.tile(tile)->finest().size());
      return &place->second;
    });
  }

  std::optional<CityTile> make_tile(const TileId& id, const Neighborhoods& near, UpdateCounts& counts,
                                    const SaveTile& save) const {
    const Windows windows = windows_of(id, near);
    const VoxelLevel& map = windows.map.finest();
    const VoxelLevel& drive = windows.drive.finest();
    const VoxelFates fates(map, drive, seen_through(windows.map, near.map, gone_),
                           seen_through(windows.drive, near.drive, moved_), options_.update.trust);
    counts = fates.counts(box_of_tile(id, map.voxel_size()));
    const VoxelMap after = voxels_after(windows.map, windows.drive, fates);
    const VoxelMap tile = in_layout(cut_tile(after, id), layout_);
    const std::optional<Visibility> seen = visibility_of(id, near, windows, fates, after, tile);
    if (tile.finest().size() == 0 && !seen) return std::nullopt;
    return save(id, tile, seen);
  }

  // Nothing where nothing was and is known.
  std::optional<Visibility> visibility_of(const TileId& id, const Neighborhoods& near, const Windows& windows,
                                          const VoxelFates& fates, const VoxelMap& after, const VoxelMap& tile) const {
    const VoxelLevel& map = windows.map.finest();
    const VoxelLevel& drive = windows.drive.finest();
    std::optional<Visibility> before;
    const CityTile* known = find_tile(cities_[kMap]->manifest, id);
    if (known && known->has_rays) {
      const VoxelMap& loaded = *near.map.tile(id);
      before = spread_visibility(*load_tile_visibility(*cities_[kMap], *known, loaded), loaded.finest(), map);
    }
    const std::optional<TileFindings> found = findings_.read(id);
    const auto passes = [&](Side side, const VoxelLevel& window, const TileNeighborhood& tiles) {
      return values_in<std::uint32_t>(window, tiles, [&](const TileId& other) {
        return found && other == id ? &found->maps[side].passes : nullptr;
      });
    };
    const std::vector<std::uint32_t> map_passes = passes(kMap, map, near.map);
    const std::vector<std::uint32_t> drive_passes = passes(kDrive, drive, near.drive);
    const VoxelTree nothing{{}};
    const Visibility seen =
        cut_visibility(visibility_after(after.finest(), map, before, drive,
                                        {map_passes, drive_passes, found ? found->seen_empty : nothing}, fates),
                       after.finest(), id, tile.finest());
    const bool is_known = known && known->has_rays;
    if (!is_known && !found && seen.seen_empty.leaves().empty()) return std::nullopt;
    return seen;
  }

  const City& drive_city_;
  std::array<std::optional<City>, 2> cities_;
  const FindingsFolder& findings_;
  const CityUpdateOptions& options_;
  CityLayout layout_;
  double margin_;  // [m]
  TileGroups gone_;
  TileGroups moved_;
  std::vector<TileId> ids_;  // that may change, sorted
  UpdateCounts counts_;
};

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
  check_new(sources, base);
  CityUpdateOptions chosen = options;
  chosen.update.epoch = epoch_after(base.manifest, options.update.epoch);

  const AtomicFolder work(writer.folder() / "sums");
  const City drive = make_drive(base, clouds, made_folder(work.temporary_path() / "drive"), chosen);
  RayWindows rays({&base, &drive}, chosen.update.trust, chosen.memory_bytes,
                  made_folder(work.temporary_path() / "rays"));
  clouds([&](const PosedCloud& posed) { rays.add(posed); });
  rays.finish();

  DrivenTiles driven(base, drive, rays, chosen);
  chosen.on_tiles_begun(driven.ids().size());
  driven.judge();
  const CityLayout& layout = driven.layout();
  const SaveTile save = [&](const TileId& id, const VoxelMap& tile, const std::optional<Visibility>& seen) {
    return writer.save_tile(id, tile, layout.density, seen);
  };
  std::vector<CityTile> made = driven.make(save);
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
