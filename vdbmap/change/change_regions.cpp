// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/change/change_regions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "vdbmap/core/option_check.h"
#include "vdbmap/core/voxel_groups.h"

namespace vdbmap {
namespace {

std::vector<VoxelIndex> indices_of(const VoxelLevel& level) {
  std::vector<VoxelIndex> indices;
  indices.reserve(level.size());
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t) { indices.push_back(voxel); });
  return indices;
}

// The label of most voxels that have one, the lowest of equals.
std::int32_t common_label(const std::vector<std::int32_t>& labels, const VoxelGroup& group) {
  std::map<std::int32_t, std::size_t> counts;
  for (const std::size_t record : group) {
    if (!labels.empty() && labels[record] != kNoLabel) ++counts[labels[record]];
  }
  const auto most = std::ranges::max_element(counts, {}, [](const auto& count) { return count.second; });
  return most == counts.end() ? kNoLabel : most->first;
}

ChangeRegion region_of(const ChangedVoxels& voxels, Change kind, const std::vector<VoxelIndex>& indices,
                       const VoxelGroup& group, const Eigen::Vector3d& anchor) {
  const double size = voxels.level.voxel_size();
  ChangeRegion region;
  region.kind = kind;
  region.num_voxels = group.size();
  region.volume = static_cast<double>(group.size()) * size * size * size;
  region.label = common_label(voxels.level.channels().labels, group);
  region.bottom = std::numeric_limits<double>::infinity();
  region.top = -region.bottom;
  std::vector<Eigen::Vector2d> places;
  double sum = 0;
  for (const std::size_t record : group) {
    const Eigen::Vector3d mean = mean_of(voxels.level.records()[record], indices[record], size);
    places.emplace_back(mean.head<2>());
    region.bottom = std::min(region.bottom, mean.z());
    region.top = std::max(region.top, mean.z());
    sum += voxels.confidences[record];
  }
  region.plan = smallest_rectangle(places);
  region.plan.center += anchor.head<2>();
  region.bottom += anchor.z();
  region.top += anchor.z();
  region.confidence = sum / static_cast<double>(group.size());
  return region;
}

void add_regions(const ChangedVoxels& voxels, Change kind, const MapDiff& diff, const RegionOptions& options,
                 std::vector<ChangeRegion>& regions) {
  const double size = voxels.level.voxel_size();
  constexpr double kTolerance = 1e-9;
  const auto reach = std::max(1, static_cast<std::int32_t>(std::floor(options.reach / size + kTolerance)));
  const auto fewest = static_cast<std::size_t>(std::ceil(options.least_volume / (size * size * size) - kTolerance));
  const std::vector<VoxelIndex> indices = indices_of(voxels.level);
  for (const VoxelGroup& group : find_groups(voxels.level, std::vector<std::uint8_t>(voxels.level.size(), 1), reach)) {
    if (group.size() >= fewest) regions.push_back(region_of(voxels, kind, indices, group, diff.frame.anchor));
  }
}

}  // namespace

void RegionOptions::check() const {
  require(reach > 0 && reach <= 10, "reach", reach, "more than 0 and at most 10 m");
  require(least_volume >= 0 && std::isfinite(least_volume), "least_volume", least_volume, "0 m^3 or more");
}

std::vector<ChangeRegion> find_regions(const MapDiff& diff, const RegionOptions& options) {
  options.check();
  std::vector<ChangeRegion> regions;
  add_regions(diff.appeared, Change::kAppeared, diff, options, regions);
  add_regions(diff.vanished, Change::kVanished, diff, options, regions);
  add_regions(diff.changed, Change::kChanged, diff, options, regions);
  std::ranges::stable_sort(regions, std::ranges::greater(), &ChangeRegion::num_voxels);
  for (std::size_t i = 0; i < regions.size(); ++i) regions[i].id = i + 1;
  return regions;
}

}  // namespace vdbmap
