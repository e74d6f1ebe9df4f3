// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/driven_tiles.h"

#include <algorithm>
#include <map>
#include <utility>

#include "vdbmap/core/map_tiles.h"
#include "vdbmap/core/parallel_tasks.h"
#include "vdbmap/store/tile_visibility.h"

namespace vdbmap {
namespace {

enum Side : std::size_t { kMap, kDrive };  // of findings

using FoundAround = std::map<TileId, TileFindings>;

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

// What was found in a tile and in those around it.
FoundAround read_around(const FindingsFolder& findings, const TileId& id) {
  FoundAround around;
  for (std::int32_t x = id.x - 1; x <= id.x + 1; ++x) {
    for (std::int32_t y = id.y - 1; y <= id.y + 1; ++y) {
      if (std::optional<TileFindings> found = findings.read({x, y})) around.emplace(TileId{x, y}, std::move(*found));
    }
  }
  return around;
}

// What was found of the records of a window; `pick` chooses what.
template <typename Value, typename Pick>
std::vector<Value> found_in(const VoxelMap& window, const TileNeighborhood& tiles, const FoundAround& around,
                            const Pick& pick) {
  return values_in<Value>(window.finest(), tiles, [&](const TileId& id) -> const std::vector<Value>* {
    const auto found = around.find(id);
    return found == around.end() ? nullptr : &pick(found->second);
  });
}

// Of the records of a window, which were seen through.
std::vector<std::uint8_t> seen_through_in(const VoxelMap& window, const TileNeighborhood& tiles,
                                          const TileGroups& groups) {
  std::map<TileId, std::vector<std::uint8_t>> known;
  return values_in<std::uint8_t>(window.finest(), tiles, [&](const TileId& id) {
    const auto [place, is_new] = known.try_emplace(id);
    if (is_new) place->second = groups.seen_through(id, tiles.tile(id)->finest().size());
    return &place->second;
  });
}

}  // namespace

DrivenTiles::DrivenTiles(const City& city, const City& drive, const RayWindows& rays, UpdateOptions options)
    : city_(city),
      drive_(drive),
      findings_(rays.findings()),
      options_(std::move(options)),
      layout_(layout_after(city, drive)),
      margin_(neighbor_margin(city.manifest.layout.voxel_sizes)),
      gone_(options_.gone),
      moved_(options_.moved) {
  for (const TileId& id : rays.tiles_nearby()) {
    if (rays.tiles().contains(id) || find_tile(city.manifest, id)) ids_.push_back(id);
  }
}

void DrivenTiles::judge() {
  in_batches([&](std::span<const TileId> batch, const Neighborhoods& near) {
    std::vector<Grades> grades(batch.size());
    parallel_tasks(batch.size(), [&](std::size_t i) { grades[i] = grade(batch[i], near); });
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (const VoxelMap* map = near.map.tile(batch[i])) gone_.add(batch[i], map->finest(), grades[i].map);
      if (const VoxelMap* drive = near.drive.tile(batch[i])) moved_.add(batch[i], drive->finest(), grades[i].drive);
    }
  });
}

std::vector<CityTile> DrivenTiles::make(const SaveTile& save, const std::function<void()>& on_tile_done) {
  std::vector<CityTile> tiles;
  in_batches([&](std::span<const TileId> batch, const Neighborhoods& near) {
    std::vector<std::optional<CityTile>> made(batch.size());
    std::vector<UpdateCounts> counts(batch.size());
    parallel_tasks(batch.size(), [&](std::size_t i) {
      made[i] = make_tile(batch[i], near, counts[i], save);
      on_tile_done();
    });
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (made[i]) tiles.push_back(std::move(*made[i]));
      counts_ = counts_ + counts[i];
    }
  });
  return tiles;
}

// Calls body(tiles, what is loaded of and around them), one tile a thread at a time.
template <typename Body>
void DrivenTiles::in_batches(const Body& body) const {
  Neighborhoods near{TileNeighborhood(city_), TileNeighborhood(drive_)};
  const std::size_t batch_size = num_threads();
  for (std::size_t begin = 0; begin < ids_.size(); begin += batch_size) {
    const std::span batch = std::span(ids_).subspan(begin, std::min(batch_size, ids_.size() - begin));
    near.map.load_around(batch);
    near.drive.load_around(batch);
    body(batch, near);
  }
}

DrivenTiles::Windows DrivenTiles::windows_of(const TileId& id, const Neighborhoods& near) const {
  const auto window = [&](const TileNeighborhood& tiles, const CityLayout& layout) {
    VoxelMap map = tiles.window(id, margin_).value_or(empty_map(layout.frame, layout.voxel_sizes));
    map.frame = layout_.frame;
    map.has_color = layout.has_color;
    map.label_scheme = layout_.label_scheme;
    return map;
  };
  return {window(near.map, city_->manifest.layout), window(near.drive, drive_->manifest.layout)};
}

DrivenTiles::Grades DrivenTiles::grade(const TileId& id, const Neighborhoods& near) const {
  const Windows windows = windows_of(id, near);
  const FoundAround around = read_around(findings_, id);
  const auto presence = found_in<TimeBins>(
      windows.drive, near.drive, around, [](const TileFindings& found) -> const auto& { return found.presence; });
  const auto grades = [&](Side side, const VoxelMap& window, const TileNeighborhood& tiles,
                          const SeenThroughOptions& options) {
    const auto passes = found_in<std::uint32_t>(
        window, tiles, around, [&](const TileFindings& found) -> const auto& { return found.maps[side].passes; });
    const auto times = found_in<TimeBins>(
        window, tiles, around, [&](const TileFindings& found) -> const auto& { return found.maps[side].pass_times; });
    return values_of_tile(
        window.finest(), id,
        grade_seen_through(window.finest(), passes, times, windows.drive.finest(), presence, options));
  };
  return {grades(kMap, windows.map, near.map, options_.gone),
          grades(kDrive, windows.drive, near.drive, options_.moved)};
}

std::optional<CityTile> DrivenTiles::make_tile(const TileId& id, const Neighborhoods& near, UpdateCounts& counts,
                                               const SaveTile& save) const {
  const Windows windows = windows_of(id, near);
  const VoxelFates fates(windows.map.finest(), windows.drive.finest(), seen_through_in(windows.map, near.map, gone_),
                         seen_through_in(windows.drive, near.drive, moved_), options_.trust);
  counts = fates.counts(box_of_tile(id, windows.map.finest().voxel_size()));
  const VoxelMap after = voxels_after(windows.map, windows.drive, fates);
  const VoxelMap tile = in_layout(cut_tile(after, id), layout_);
  const std::optional<Visibility> seen = visibility_of(id, near, windows, fates, after, tile);
  if (tile.finest().size() == 0 && !seen) return std::nullopt;
  return save(id, tile, seen);
}

// As that of a window around the tile.
std::optional<Visibility> DrivenTiles::visibility_before(const TileId& id, const Neighborhoods& near,
                                                         const VoxelLevel& window) const {
  const CityTile* known = find_tile(city_->manifest, id);
  if (!known || !known->has_rays) return std::nullopt;
  const VoxelMap& loaded = *near.map.tile(id);
  return spread_visibility(*load_tile_visibility(*city_, *known, loaded), loaded.finest(), window);
}

// Nothing where nothing was and is known.
std::optional<Visibility> DrivenTiles::visibility_of(const TileId& id, const Neighborhoods& near,
                                                     const Windows& windows, const VoxelFates& fates,
                                                     const VoxelMap& after, const VoxelMap& tile) const {
  const std::optional<Visibility> before = visibility_before(id, near, windows.map.finest());
  std::optional<TileFindings> found = findings_.read(id);
  const bool is_known = before || found;
  FoundAround around;
  if (found) around.emplace(id, std::move(*found));
  const auto passes = [&](Side side, const VoxelMap& window, const TileNeighborhood& tiles) {
    return found_in<std::uint32_t>(
        window, tiles, around, [&](const TileFindings& here) -> const auto& { return here.maps[side].passes; });
  };
  const std::vector<std::uint32_t> map_passes = passes(kMap, windows.map, near.map);
  const std::vector<std::uint32_t> drive_passes = passes(kDrive, windows.drive, near.drive);
  const VoxelTree nothing{{}};
  const RaysOfDrive rays{map_passes, drive_passes, around.empty() ? nothing : around.at(id).seen_empty};
  const Visibility seen =
      visibility_after(after.finest(), windows.map.finest(), before, windows.drive.finest(), rays, fates);
  Visibility of_tile = cut_visibility(seen, after.finest(), id, tile.finest());
  if (!is_known && of_tile.seen_empty.leaves().empty()) return std::nullopt;
  return of_tile;
}

}  // namespace vdbmap
