// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/map_builder.h"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "vdbmap/core/hierarchy.h"
#include "vdbmap/core/normals.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/core/point_fold.h"

namespace vdbmap {
namespace {

// Points folded at once: 20 bytes of working memory each.
constexpr std::size_t kChunkSize = std::size_t{1} << 23;

// What the finest level is made of, block by block.
struct FinestParts {
  std::vector<std::unique_ptr<VoxelLeaf>> leaves;
  std::vector<VoxelRecord> records;
  std::vector<float> intensities;
};

}  // namespace

struct MapBuilder::State {
  BuildOptions options;
  double voxels_per_metre = 0;
  std::optional<Eigen::Vector3d> anchor;  // from the options, else chosen by the first point
  std::map<BlockKey, BlockSums> blocks;
  std::size_t num_points = 0;
  bool has_color = false;
  bool has_intensity = false;

  void fold(const PointCloud& cloud, std::size_t begin, std::size_t end, const Eigen::Isometry3d& local_from_cloud);
  FinestParts take_finest_parts();
  VoxelLevel take_finest_level();
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

void MapBuilder::add(const PointCloud& cloud, const Eigen::Isometry3d& map_from_cloud) {
  if (cloud.empty()) return;
  std::optional<Eigen::Vector3d>& anchor = state_->anchor;
  if (!anchor) anchor = choose_anchor(map_from_cloud * cloud.positions.front());

  Eigen::Isometry3d local_from_cloud = map_from_cloud;
  local_from_cloud.translation() -= *anchor;
  for (std::size_t begin = 0; begin < cloud.size(); begin += kChunkSize) {
    state_->fold(cloud, begin, std::min(cloud.size(), begin + kChunkSize), local_from_cloud);
  }
  state_->num_points += cloud.size();
  state_->has_color |= !cloud.colors.empty();
  state_->has_intensity |= !cloud.intensities.empty();
}

void MapBuilder::State::fold(const PointCloud& cloud, std::size_t begin, std::size_t end,
                             const Eigen::Isometry3d& local_from_cloud) {
  std::vector<FoldedBlock> folded = fold_points(cloud, begin, end, local_from_cloud, voxels_per_metre);
  std::vector<BlockSums*> targets;
  for (const FoldedBlock& part : folded) targets.push_back(&blocks[part.block]);
  parallel_for(folded.size(),
               [&](std::size_t i) { *targets[i] = merge_blocks(std::move(*targets[i]), std::move(folded[i].voxels)); });
}

FinestParts MapBuilder::State::take_finest_parts() {
  std::vector<std::pair<BlockKey, BlockSums*>> sources;
  std::vector<std::size_t> first_record = {0};
  for (auto& [key, voxels] : blocks) {
    sources.emplace_back(key, &voxels);
    first_record.push_back(first_record.back() + voxels.size());
  }

  FinestParts parts;
  parts.records.resize(first_record.back());
  if (has_intensity) parts.intensities.resize(first_record.back());
  std::vector<std::vector<std::unique_ptr<VoxelLeaf>>> leaves(sources.size());
  parallel_for(sources.size(), [&](std::size_t i) {
    BlockSums voxels = std::move(*sources[i].second);  // freed as soon as it is converted
    leaves[i] = leaves_of_block(sources[i].first, voxels);
    for (std::size_t v = 0; v < voxels.size(); ++v) {
      parts.records[first_record[i] + v] = record_of(voxels[v].sums, options.voxel_sizes.front());
      if (has_intensity) parts.intensities[first_record[i] + v] = intensity_of(voxels[v].sums);
    }
  });
  for (auto& block : leaves) std::move(block.begin(), block.end(), std::back_inserter(parts.leaves));
  return parts;
}

VoxelLevel MapBuilder::State::take_finest_level() {
  FinestParts parts = take_finest_parts();
  blocks.clear();
  VoxelChannels channels;
  channels.intensities = std::move(parts.intensities);
  if (options.epoch) {
    channels.first_epochs.assign(parts.records.size(), *options.epoch);
    channels.last_epochs = channels.first_epochs;
  }
  VoxelLevel level(options.voxel_sizes.front(), std::move(parts.leaves), std::move(parts.records), std::move(channels));
  compute_normals(level);
  return level;
}

VoxelMap MapBuilder::finish() {
  VoxelMap map;
  map.frame.anchor = state_->anchor.value_or(Eigen::Vector3d::Zero());
  map.frame.epsg = state_->options.epsg;
  map.has_color = state_->has_color;
  map.levels.push_back(state_->take_finest_level());
  add_coarser_levels(map, state_->options.voxel_sizes);
  *this = MapBuilder(state_->options);
  return map;
}

VoxelMap build_map(const PointCloud& cloud, const BuildOptions& options) {
  MapBuilder builder(options);
  builder.add(cloud);
  return builder.finish();
}

}  // namespace vdbmap
