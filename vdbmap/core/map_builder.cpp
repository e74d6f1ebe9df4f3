// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/map_builder.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "vdbmap/core/anchor_choice.h"
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
  explicit State(BuildOptions build_options)
      : options(std::move(build_options)),
        voxels_per_metre(vdbmap::voxels_per_metre(options.voxel_sizes.front())),
        anchor(options.anchor) {}

  BuildOptions options;
  double voxels_per_metre;
  std::optional<Eigen::Vector3d> anchor;  // from the options, else chosen for the first cloud
  VoxelBlocks blocks;
  std::size_t num_points = 0;
  bool has_color = false;
  bool has_intensity = false;
  bool has_labels = false;

  UnreachablePoints unreachable;  // of the last cloud

  void begin(const PointCloud& cloud, const Eigen::Isometry3d& map_from_cloud);
  SortedPoints sort(const PointCloud& cloud, std::size_t begin, std::size_t end,
                    const Eigen::Isometry3d& map_from_cloud);
  void add_up_to(std::size_t end, const PointCloud& cloud, const Eigen::Isometry3d& map_from_cloud);
  VoxelMap make_map(std::optional<SortedPoints> last_points);
  VoxelMap make_map_and_begin_anew(std::optional<SortedPoints> last_points);
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

MapBuilder::MapBuilder(BuildOptions options) {
  options.check();
  state_ = std::make_unique<State>(std::move(options));
}

MapBuilder::~MapBuilder() = default;
MapBuilder::MapBuilder(MapBuilder&&) noexcept = default;
MapBuilder& MapBuilder::operator=(MapBuilder&&) noexcept = default;

std::size_t MapBuilder::num_points() const { return state_->num_points; }

const UnreachablePoints& MapBuilder::unreachable() const { return state_->unreachable; }

void MapBuilder::State::begin(const PointCloud& cloud, const Eigen::Isometry3d& map_from_cloud) {
  unreachable = {0, Eigen::Vector3d::Zero(), kIndexLimit / voxels_per_metre};
  if (!anchor) anchor = anchor_for(cloud, map_from_cloud, voxels_per_metre);
  has_color |= !cloud.colors.empty();
  has_intensity |= !cloud.intensities.empty();
  has_labels |= !cloud.labels.empty();
}

SortedPoints MapBuilder::State::sort(const PointCloud& cloud, std::size_t begin, std::size_t end,
                                     const Eigen::Isometry3d& map_from_cloud) {
  Eigen::Isometry3d local_from_cloud = map_from_cloud;
  local_from_cloud.translation() -= *anchor;
  SortedPoints sorted(cloud, begin, end, local_from_cloud, voxels_per_metre);
  if (unreachable.count == 0) unreachable.first = cloud.positions[sorted.first_unreachable()];
  unreachable.count += sorted.num_unreachable();
  num_points += end - begin - sorted.num_unreachable();
  return sorted;
}

// Adds the points before `end`, chunk by chunk.
void MapBuilder::State::add_up_to(std::size_t end, const PointCloud& cloud, const Eigen::Isometry3d& map_from_cloud) {
  for (std::size_t begin = 0; begin < end; begin += kChunkSize) {
    add_points(blocks, sort(cloud, begin, std::min(end, begin + kChunkSize), map_from_cloud));
  }
}

void MapBuilder::add(const PointCloud& cloud, const Eigen::Isometry3d& map_from_cloud) {
  state_->unreachable = {};
  if (cloud.empty()) return;
  state_->begin(cloud, map_from_cloud);
  state_->add_up_to(cloud.size(), cloud, map_from_cloud);
  check_reached(state_->unreachable, cloud.size());
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

VoxelMap MapBuilder::State::make_map_and_begin_anew(std::optional<SortedPoints> last_points) {
  VoxelMap map = make_map(std::move(last_points));
  const UnreachablePoints of_last_cloud = unreachable;
  *this = State(std::move(options));
  unreachable = of_last_cloud;
  return map;
}

VoxelMap MapBuilder::finish() { return state_->make_map_and_begin_anew(std::nullopt); }

VoxelMap MapBuilder::finish(const PointCloud& last_cloud, const Eigen::Isometry3d& map_from_cloud) {
  state_->unreachable = {};
  if (last_cloud.empty()) return finish();
  state_->begin(last_cloud, map_from_cloud);
  const std::size_t last_chunk = (last_cloud.size() - 1) / kChunkSize * kChunkSize;
  state_->add_up_to(last_chunk, last_cloud, map_from_cloud);
  SortedPoints last_points = state_->sort(last_cloud, last_chunk, last_cloud.size(), map_from_cloud);
  check_reached(state_->unreachable, last_cloud.size());
  return state_->make_map_and_begin_anew(std::move(last_points));
}

VoxelMap build_map(const PointCloud& cloud, const BuildOptions& options) { return MapBuilder(options).finish(cloud); }

}  // namespace vdbmap
