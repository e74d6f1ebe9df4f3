// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/hierarchy.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vdbmap/core/label_votes.h"
#include "vdbmap/core/normals.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/core/voxel_assembly.h"

namespace vdbmap {
namespace {

// What a parent gathers from its children; positions count from its own centre, so that nothing cancels.
struct ParentSums {
  double count = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // [m]
  Eigen::Matrix3d product = Eigen::Matrix3d::Zero();   // [m^2]
  Eigen::Vector3d color = Eigen::Vector3d::Zero();
  double intensity = 0;
  std::int32_t first_epoch = std::numeric_limits<std::int32_t>::max();
  std::int32_t last_epoch = std::numeric_limits<std::int32_t>::min();

  void add(const ParentSums& other) {
    count += other.count;
    position += other.position;
    product += other.product;
    color += other.color;
    intensity += other.intensity;
    first_epoch = std::min(first_epoch, other.first_epoch);
    last_epoch = std::max(last_epoch, other.last_epoch);
  }
};

struct KeyedParent {
  VoxelIndex voxel;
  VoxelKey key;
  ParentSums sums;
};

ParentSums sums_of_child(const VoxelLevel& fine, std::size_t number, const VoxelIndex& child,
                         const Eigen::Vector3d& parent_center) {
  const VoxelRecord& record = fine.records()[number];
  const VoxelChannels& channels = fine.channels();
  const Eigen::Vector3d mean = mean_of(record, child, fine.voxel_size()) - parent_center;

  ParentSums sums;
  sums.count = record.count;
  sums.position = sums.count * mean;
  sums.product = covariance_of(record) * (sums.count - 1) + sums.count * mean * mean.transpose();
  sums.color = sums.count * color_of(record);
  if (!channels.intensities.empty()) sums.intensity = sums.count * channels.intensities[number];
  if (!channels.first_epochs.empty()) sums.first_epoch = channels.first_epochs[number];
  if (!channels.last_epochs.empty()) sums.last_epoch = channels.last_epochs[number];
  return sums;
}

// Parents of one leaf's voxels; few, so a linear search finds them.
void gather_parents(const VoxelLevel& fine, const VoxelLeaf& leaf, std::int32_t factor,
                    std::vector<KeyedParent>& parents) {
  const std::size_t first_of_leaf = parents.size();
  for_each_voxel(leaf, [&](const VoxelIndex& child, std::size_t number) {
    const VoxelIndex voxel = parent_of_voxel(child, factor);
    auto parent = std::find_if(parents.rbegin(), parents.rend() - static_cast<std::ptrdiff_t>(first_of_leaf),
                               [&](const KeyedParent& candidate) { return candidate.voxel == voxel; });
    if (parent == parents.rend() - static_cast<std::ptrdiff_t>(first_of_leaf)) {
      parents.push_back({voxel, key_of_voxel(voxel), {}});
      parent = parents.rbegin();
    }
    parent->sums.add(sums_of_child(fine, number, child, center_of_voxel(voxel, fine.voxel_size() * factor)));
  });
}

std::vector<KeyedParent> gather_all_parents(const VoxelLevel& fine, std::int32_t factor) {
  constexpr std::size_t kLeavesPerRange = 256;  // fixed, so that sums do not depend on the threads
  const std::vector<const VoxelLeaf*> leaves = fine.leaves();
  std::vector<std::vector<KeyedParent>> ranges((leaves.size() + kLeavesPerRange - 1) / kLeavesPerRange);
  parallel_for(ranges.size(), [&](std::size_t i) {
    const std::size_t end = std::min(leaves.size(), (i + 1) * kLeavesPerRange);
    for (std::size_t leaf = i * kLeavesPerRange; leaf < end; ++leaf) {
      gather_parents(fine, *leaves[leaf], factor, ranges[i]);
    }
  });

  std::vector<KeyedParent> parents;
  for (const auto& range : ranges) parents.insert(parents.end(), range.begin(), range.end());
  return parents;
}

// Adds up the parts of each parent in the order of the leaves they came from.
std::vector<KeyedParent> fold_parents(std::vector<KeyedParent> parts) {
  std::vector<std::uint32_t> order(parts.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return parts[a].key < parts[b].key; });

  std::vector<KeyedParent> folded;
  for (const std::uint32_t i : order) {
    if (!folded.empty() && folded.back().key == parts[i].key) {
      folded.back().sums.add(parts[i].sums);
    } else {
      folded.push_back(parts[i]);
    }
  }
  return folded;
}

VoxelRecord record_of(const KeyedParent& parent, double voxel_size) {
  const ParentSums& sums = parent.sums;
  const Eigen::Vector3d mean = sums.position / sums.count;
  Moments moments;
  moments.count = static_cast<std::int64_t>(sums.count);
  moments.mean = center_of_voxel(parent.voxel, voxel_size) + mean;
  moments.scatter = sums.product - sums.count * mean * mean.transpose();

  VoxelRecord record;
  set_moments(record, moments, parent.voxel, voxel_size);
  set_color(record, sums.color / sums.count);
  return record;
}

}  // namespace

VoxelLevel coarsen(const VoxelLevel& fine, std::int32_t factor) {
  const double voxel_size = factor / voxels_per_metre(fine.voxel_size());
  const std::vector<KeyedParent> parents = fold_parents(gather_all_parents(fine, factor));

  const bool has_labels = !fine.channels().labels.empty();
  const std::vector<LabelVotes> votes = has_labels ? votes_for_parents(fine, factor) : std::vector<LabelVotes>();
  LabelElection election(votes);

  VoxelAssembly assembly(voxel_size, parents.size());
  for (const KeyedParent& parent : parents) {
    [[maybe_unused]] const bool in_order = assembly.add(parent.voxel, record_of(parent, voxel_size));
    if (!fine.channels().intensities.empty()) {
      assembly.channels().intensities.push_back(static_cast<float>(parent.sums.intensity / parent.sums.count));
    }
    if (has_labels) assembly.channels().labels.push_back(election.winner(parent.key));
    if (!fine.channels().first_epochs.empty()) assembly.channels().first_epochs.push_back(parent.sums.first_epoch);
    if (!fine.channels().last_epochs.empty()) assembly.channels().last_epochs.push_back(parent.sums.last_epoch);
  }
  VoxelLevel level = assembly.finish();
  compute_normals(level);
  return level;
}

void add_coarser_levels(VoxelMap& map, const std::vector<double>& voxel_sizes) {
  for (std::size_t i = 1; i < voxel_sizes.size(); ++i) {
    map.levels.push_back(coarsen(map.levels.back(), level_factor(voxel_sizes[i - 1], voxel_sizes[i])));
  }
}

}  // namespace vdbmap
