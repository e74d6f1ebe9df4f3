// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/city_build.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "vdbmap/core/anchor_choice.h"
#include "vdbmap/core/error.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/io/file/atomic_folder.h"
#include "vdbmap/store/city_window.h"
#include "vdbmap/store/city_writer.h"
#include "vdbmap/store/source_hash.h"
#include "vdbmap/store/tile_finish.h"
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

// What the points of all sources are like.
struct PointKinds {
  bool has_color = false;
  bool has_intensity = false;
  bool has_labels = false;

  void add(const PointCloud& cloud) {
    has_color |= !cloud.colors.empty();
    has_intensity |= !cloud.intensities.empty();
    has_labels |= !cloud.labels.empty();
  }
};

// Sums of the points of all sources, and what was learnt on the way.
struct CountedPoints {
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();
  PointKinds kinds;
  InputNotes notes;
};

// [points] that are read and sorted at once: they take some 250 bytes each, with those read ahead, until they are sums;
// of these points a third of the memory. The more of them, the fewer times sums are merged.
std::size_t points_at_once(std::size_t memory_bytes) {
  return std::clamp<std::size_t>(memory_bytes / 3 / 250, std::size_t{1} << 14, std::size_t{1} << 21);
}

// Sums take half of the memory: the rest is for points on their way, and tiles when they are finished.
std::size_t bytes_of_sums(std::size_t memory_bytes) { return memory_bytes / 2; }

UnreachablePoints add_cloud(TileSums& sums, const PointCloud& cloud, const Eigen::Isometry3d& local_from_cloud,
                            double per_metre, std::size_t at_once) {
  UnreachablePoints unreachable{0, Eigen::Vector3d::Zero(), kIndexLimit / per_metre};
  for (std::size_t begin = 0; begin < cloud.size(); begin += at_once) {
    const SortedPoints sorted(cloud, begin, std::min(cloud.size(), begin + at_once), local_from_cloud, per_metre);
    if (unreachable.count == 0 && sorted.num_unreachable() > 0) {
      unreachable.first = cloud.positions[sorted.first_unreachable()];
    }
    unreachable.count += sorted.num_unreachable();
    sums.add(sorted);
  }
  return unreachable;
}

// The anchor that all points of an input decide, read in pieces: anchor_for() of them together.
Eigen::Vector3d anchor_of_large(const MapInput& input, const InputOptions& options, double per_metre) {
  const Eigen::Isometry3d pose = pose_of(input);
  InputOptions quiet = options;
  quiet.on_scan_done = [] {};
  std::optional<Eigen::Vector3d> near_first;
  std::size_t num_reached = 0;
  std::size_t num_points = 0;
  read_inputs({input}, quiet, [&](const InputPoints& points) {
    if (!near_first) near_first = choose_anchor(pose * points.cloud.positions.front());
    num_points += points.cloud.size();
    num_reached += count_reached(*near_first, points.cloud, pose, per_metre);
    return UnreachablePoints();
  });
  if (is_anchor(*near_first) && 2 * num_reached > num_points) return *near_first;
  quiet.most_points = std::numeric_limits<std::size_t>::max();
  Eigen::Vector3d anchor;
  read_inputs({input}, quiet, [&](const InputPoints& points) {
    anchor = anchor_for(points.cloud, pose, per_metre);
    return UnreachablePoints();
  });
  return anchor;
}

CountedPoints count_points(TileSums& sums, NewSources& counted, const CityBuildOptions& options) {
  const double per_metre = voxels_per_metre(options.files.build.voxel_sizes.front());
  InputOptions inputs = options.files.inputs;
  inputs.most_points = points_at_once(options.memory_bytes);
  options.on_reading_begun(counted.inputs.size());
  std::optional<Eigen::Vector3d> anchor = options.files.build.anchor;
  CountedPoints points;
  points.notes = read_inputs(counted.inputs, inputs, [&](const InputPoints& read) {
    if (read.cloud.empty()) return UnreachablePoints();
    const MapInput& input = counted.inputs[read.index];
    Eigen::Isometry3d local_from_cloud = pose_of(input);
    if (!anchor) {
      anchor = read.is_whole ? anchor_for(read.cloud, local_from_cloud, per_metre)
                             : anchor_of_large(input, inputs, per_metre);
    }
    local_from_cloud.translation() -= *anchor;
    points.kinds.add(read.cloud);
    const UnreachablePoints unreachable = add_cloud(sums, read.cloud, local_from_cloud, per_metre, inputs.most_points);
    counted.sources[read.index].num_points += read.cloud.size() - unreachable.count;
    return unreachable;
  });
  points.anchor = *anchor;
  return points;
}

CityLayout layout_of_points(const CountedPoints& points, const CityBuildOptions& options) {
  CityLayout layout;
  layout.frame = {points.anchor, options.files.build.epsg ? options.files.build.epsg : points.notes.epsg_of_files};
  layout.voxel_sizes = exact_voxel_sizes(options.files.build.voxel_sizes);
  layout.has_color = points.kinds.has_color;
  if (points.kinds.has_intensity) layout.channels.emplace_back("intensity");
  if (points.kinds.has_labels) layout.channels.emplace_back("label");
  if (options.files.build.epoch) layout.channels.insert(layout.channels.end(), {"first_epoch", "last_epoch"});
  layout.label_scheme = points.notes.label_scheme;
  layout.density = options.save.density;
  return layout;
}

// The tiles with new points in or around them, finished and saved, in batches of one a thread.
std::vector<CityTile> save_new_tiles(const CityWriter& writer, const std::optional<City>& base, TileSums& sums,
                                     const CityLayout& added, const CityLayout& layout,
                                     const CityBuildOptions& options) {
  const FinestLevelOptions finest{layout.voxel_sizes.front(), std::ranges::count(added.channels, "intensity") > 0,
                                  std::ranges::count(added.channels, "label") > 0, options.files.build.epoch};
  const double margin = neighbor_margin(layout.voxel_sizes);
  const std::vector<TileId> ids = sums.tiles();
  options.on_tiles_begun(ids.size());
  std::vector<std::optional<CityTile>> saved(ids.size());
  TileNeighborhood before(base);
  const std::size_t batch_size = num_threads();
  for (std::size_t begin = 0; begin < ids.size(); begin += batch_size) {
    const std::span batch = std::span(ids).subspan(begin, std::min(batch_size, ids.size() - begin));
    before.load_around(batch);
    parallel_for(batch.size(), [&](std::size_t i) {
      const TileId& id = batch[i];
      const VoxelMap tile = finish_tile(id, sums.take(id), finest, before.window(id, margin), added, layout);
      if (tile.finest().size() > 0) saved[begin + i] = writer.save_tile(id, tile, layout.density);
      options.on_tile_done();
    });
  }
  std::vector<CityTile> tiles;
  for (std::optional<CityTile>& tile : saved) {
    if (tile) tiles.push_back(std::move(*tile));
  }
  return tiles;
}

// The tiles of a city that are not renewed, in the layout that it has now.
std::vector<CityTile> keep_tiles(const CityWriter& writer, const City& base, const std::vector<TileId>& renewed,
                                 const CityLayout& layout) {
  std::vector<CityTile> kept;
  for (const CityTile& tile : base.manifest.tiles) {
    if (!std::ranges::binary_search(renewed, tile.id)) kept.push_back(tile);
  }
  if (layout == base.manifest.layout) return kept;
  parallel_for(kept.size(), [&](std::size_t i) {
    std::optional<VoxelMap> map = load_tile(base, kept[i]);
    if (!map) throw IoError::malformed(tile_path(base.folder, kept[i]), "is missing");
    kept[i] = writer.save_tile(kept[i].id, in_layout(std::move(*map), layout), layout.density);
  });
  return kept;
}

void sort_manifest(CityManifest& manifest) {
  std::ranges::sort(manifest.tiles, {}, &CityTile::id);
  std::ranges::sort(manifest.sources, {}, [](const MapSource& s) { return std::tie(s.epoch, s.name, s.hash); });
}

// A manifest that is to be published: that of `base`, or an empty one.
CityManifest begin_manifest(const std::optional<City>& base, const CityBuildOptions& options) {
  CityManifest manifest = base ? base->manifest : CityManifest();
  manifest.epoch = options.files.build.epoch.value_or(manifest.epoch);
  return manifest;
}

// Counts the new sources and publishes the city with them.
CityBuilt write_city(CityWriter& writer, const std::optional<City>& base, NewSources counted,
                     const CityBuildOptions& options) {
  CityBuilt built{begin_manifest(base, options), {}, {}, std::move(counted.not_counted)};
  const AtomicFolder spilled(writer.folder() / "sums");
  TileSums sums(options.files.build.voxel_sizes, spilled.temporary_path(), bytes_of_sums(options.memory_bytes));
  CountedPoints points = count_points(sums, counted, options);
  const CityLayout added = layout_of_points(points, options);
  CityManifest& manifest = built.manifest;
  manifest.layout = base ? merged_layout(base->manifest.layout, added) : added;
  const std::vector<TileId> renewed = sums.tiles();
  manifest.tiles = save_new_tiles(writer, base, sums, added, manifest.layout, options);
  if (base) {
    const std::vector<CityTile> kept = keep_tiles(writer, *base, renewed, manifest.layout);
    manifest.tiles.insert(manifest.tiles.end(), kept.begin(), kept.end());
  }
  for (MapSource& source : counted.sources) source.epoch = manifest.epoch;
  manifest.sources.insert(manifest.sources.end(), counted.sources.begin(), counted.sources.end());
  sort_manifest(manifest);
  writer.publish(manifest, options.keep_epochs);
  built.notes = std::move(points.notes);
  built.added = std::move(counted.sources);
  return built;
}

// The same command again may replace what it made.
void check_replaceable(const CityWriter& writer, const std::vector<MapSource>& sources) {
  if (!writer.current()) return;
  const std::vector<MapSource>& known = writer.current()->manifest.sources;
  const auto is_given = [&](const MapSource& source) {
    return std::ranges::count(sources, source.hash, &MapSource::hash) > 0;
  };
  if (writer.num_epochs() == 1 && !known.empty() && std::ranges::all_of(known, is_given)) return;
  throw std::invalid_argument(writer.folder().string() +
                              ": is a city of other sources or of several epochs, choose another output or add to it");
}

void check_epoch(const std::optional<std::int32_t>& epoch, const City& city) {
  if (epoch.value_or(city.manifest.epoch) >= city.manifest.epoch) return;
  throw std::invalid_argument("epoch is " + std::to_string(*epoch) + ", but " + city.folder.string() + " is in epoch " +
                              std::to_string(city.manifest.epoch) + " already");
}

void check_levels(const std::vector<double>& voxel_sizes, const City& city) {
  if (exact_voxel_sizes(voxel_sizes) == city.manifest.layout.voxel_sizes) return;
  throw std::invalid_argument(city.folder.string() + ": has other levels than those to be added");
}

// The options that a city's own choices leave.
CityBuildOptions options_for(const City& city, CityBuildOptions options) {
  const CityLayout& layout = city.manifest.layout;
  check_epoch(options.files.build.epoch, city);
  check_levels(options.files.build.voxel_sizes, city);
  const bool has_epochs = std::ranges::count(layout.channels, "last_epoch") > 0;
  if (has_epochs && !options.files.build.epoch) options.files.build.epoch = city.manifest.epoch;
  options.files.build.anchor = layout.frame.anchor;
  options.save.density = layout.density;
  return options;
}

}  // namespace

CityBuilt build_city(const std::filesystem::path& folder, const std::vector<MapInput>& inputs,
                     const CityBuildOptions& options) {
  options.files.build.check();
  CityWriter writer(folder);
  NewSources counted = sort_sources(inputs, identify_sources(inputs, options.on_file_hashed), {});
  check_replaceable(writer, counted.sources);
  return write_city(writer, std::nullopt, std::move(counted), options);
}

CityBuilt add_to_city(const std::filesystem::path& folder, const std::vector<MapInput>& inputs,
                      const CityBuildOptions& options) {
  options.files.build.check();
  open_city(folder);  // is no new folder
  CityWriter writer(folder);
  const std::optional<City> base = writer.current();
  const CityBuildOptions fitting = options_for(*base, options);
  NewSources counted = sort_sources(inputs, identify_sources(inputs, options.on_file_hashed), base->manifest.sources);
  if (counted.inputs.empty()) return {base->manifest, {}, {}, std::move(counted.not_counted)};
  try {
    return write_city(writer, base, std::move(counted), fitting);
  } catch (const std::invalid_argument& error) {
    throw IoError::malformed(folder, error.what());
  }
}

}  // namespace vdbmap
