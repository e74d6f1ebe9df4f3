// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/map_builder.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "vdbmap/core/finest_level.h"
#include "vdbmap/core/hierarchy.h"
#include "vdbmap/core/normals.h"
#include "vdbmap/core/sorted_points.h"

namespace vdbmap {
namespace {

// Points sorted at once: 18 bytes of working memory each.
constexpr std::size_t kChunkSize = std::size_t{1} << 23;

}  // namespace

struct MapBuilder::State {
  BuildOptions options;
  double voxels_per_metre = 0;
  std::optional<Eigen::Vector3d> anchor;  // from the options, else chosen by the first point
  VoxelBlocks blocks;
  std::size_t num_points = 0;
  bool has_color = false;
  bool has_intensity = false;
  bool has_labels = false;

  void note(const PointCloud& cloud, const Eigen::Isometry3d& map_from_cloud);
  SortedPoints sort(const PointCloud& cloud, std::size_t begin, std::size_t end,
                    const Eigen::Isometry3d& map_from_cloud) const;
  void add_up_to(std::size_t end, const PointCloud& cloud, const Eigen::Isometry3d& map_from_cloud);
  VoxelMap make_map(std::optional<SortedPoints> last_points);
};

void BuildOptions::check() const {
  if (voxel_sizes.empty()) throw std::invalid_argument("no voxel size given");
  vdbmap::voxels_per_metre(voxel_sizes.front());
  for (std::size_t i = 1; i < voxel_sizes.size(); ++i) {
    vdbmap::voxels_per_metre(voxel_sizes[i]);
    level_factor(voxel_sizes[i - 1], voxel_sizes[i]);
  }
  if (anchor) check_anchor(*anchor);
}

MapBuilder::MapBuilder(BuildOptions options) : state_(std::make_unique<State>()) {
  options.check();
  state_->voxels_per_metre = voxels_per_metre(options.voxel_sizes.front());
  state_->anchor = options.anchor;
  state_->options = std::move(options);
}

MapBuilder::~MapBuilder() = default;
MapBuilder::MapBuilder(MapBuilder&&) noexcept = default;
MapBuilder& MapBuilder::operator=(MapBuilder&&) noexcept = default;

std::size_t MapBuilder::num_points() const { return state_->num_points; }

void MapBuilder::State::note(const PointCloud& cloud, const Eigen::Isometry3d& map_from_cloud) {
  if (!anchor) anchor = choose_anchor(map_from_cloud * cloud.positions.front());
  num_points += cloud.size();
  has_color |= !cloud.colors.empty();
  has_intensity |= !cloud.intensities.empty();
  has_labels |= !cloud.labels.empty();
}

SortedPoints MapBuilder::State::sort(const PointCloud& cloud, std::size_t begin, std::size_t end,
                                     const Eigen::Isometry3d& map_from_cloud) const {
  Eigen::Isometry3d local_from_cloud = map_from_cloud;
  local_from_cloud.translation() -= *anchor;
  return {cloud, begin, end, local_from_cloud, voxels_per_metre};
}

// Adds the points before `end`, chunk by chunk.
void MapBuilder::State::add_up_to(std::size_t end, const PointCloud& cloud, const Eigen::Isometry3d& map_from_cloud) {
  for (std::size_t begin = 0; begin < end; begin += kChunkSize) {
    add_points(blocks, sort(cloud, begin, std::min(end, begin + kChunkSize), map_from_cloud));
  }
}

void MapBuilder::add(const PointCloud& cloud, const Eigen::Isometry3d& map_from_cloud) {
  if (cloud.empty()) return;
  state_->note(cloud, map_from_cloud);
  state_->add_up_to(cloud.size(), cloud, map_from_cloud);
}

VoxelMap MapBuilder::State::make_map(std::optional<SortedPoints> last_points) {
  VoxelMap map;
  map.frame.anchor = anchor.value_or(Eigen::Vector3d::Zero());
  map.frame.epsg = options.epsg;
  map.has_color = has_color;
  map.levels.push_back(make_finest_level(std::move(blocks), last_points ? &*last_points : nullptr,
                                         {options.voxel_sizes.front(), has_intensity, has_labels, options.epoch}));
  last_points.reset();
  compute_normals(map.levels.front());
  add_coarser_levels(map, options.voxel_sizes);
  return map;
}

VoxelMap MapBuilder::finish() {
  VoxelMap map = state_->make_map(std::nullopt);
  *this = MapBuilder(state_->options);
  return map;
}

VoxelMap MapBuilder::finish(const PointCloud& last_cloud, const Eigen::Isometry3d& map_from_cloud) {
  if (last_cloud.empty()) return finish();
  state_->note(last_cloud, map_from_cloud);
  const std::size_t last_chunk = (last_cloud.size() - 1) / kChunkSize * kChunkSize;
  state_->add_up_to(last_chunk, last_cloud, map_from_cloud);
  VoxelMap map = state_->make_map(state_->sort(last_cloud, last_chunk, last_cloud.size(), map_from_cloud));
  *this = MapBuilder(state_->options);
  return map;
}

VoxelMap build_map(const PointCloud& cloud, const BuildOptions& options) { return MapBuilder(options).finish(cloud); }

}  // namespace vdbmap
