// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/hierarchy.h"

#include <algorithm>
#include <compare>
#include <functional>
#include <limits>
#include <span>

#include "vdbmap/core/label_votes.h"
#include "vdbmap/core/normals.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/core/point_sums.h"
#include "vdbmap/core/voxel_assembly.h"

namespace vdbmap {
namespace {

// What a parent gathers from its children.
struct ParentSums {
  PointSums points;  // about its centre
  Eigen::Vector3d color = Eigen::Vector3d::Zero();
  double intensity = 0;
  std::int32_t first_epoch = std::numeric_limits<std::int32_t>::max();
  std::int32_t last_epoch = std::numeric_limits<std::int32_t>::min();

  void add(const ParentSums& other) {
    points.add(other.points);
    color += other.color;
    intensity += other.intensity;
    first_epoch = std::min(first_epoch, other.first_epoch);
    last_epoch = std::max(last_epoch, other.last_epoch);
  }
};

// The voxels of one leaf that one parent covers.
struct PartOfParent {
  VoxelKey parent;
  std::uint32_t leaf;  // its number

  auto operator<=>(const PartOfParent&) const = default;
};

// What is stored of a parent.
struct ParentVoxel {
  VoxelRecord record;
  float intensity = 0;
  std::int32_t first_epoch = 0;
  std::int32_t last_epoch = 0;
};

ParentSums sums_of_child(const VoxelLevel& fine, std::size_t number, const VoxelIndex& child,
                         const Eigen::Vector3d& parent_center) {
  const VoxelRecord& record = fine.records()[number];
  const VoxelChannels& channels = fine.channels();
  const double count = record.count;

  ParentSums sums;
  sums.points = sums_of(record, mean_of(record, child, fine.voxel_size()) - parent_center);
  sums.color = count * color_of(record);
  if (!channels.intensities.empty()) sums.intensity = count * channels.intensities[number];
  if (!channels.first_epochs.empty()) sums.first_epoch = channels.first_epochs[number];
  if (!channels.last_epochs.empty()) sums.last_epoch = channels.last_epochs[number];
  return sums;
}

// The voxels of a leaf that a parent covers, if they are occupied: the first and the last of the box.
struct ChildBox {
  VoxelIndex low, high;
};

ChildBox box_of_children(const VoxelLeaf& leaf, const VoxelIndex& parent, std::int32_t factor) {
  const VoxelIndex first = first_child_of_voxel(parent, factor);
  return {VoxelIndex::maxComponent(first, leaf.origin()),
          VoxelIndex::minComponent(first.offsetBy(factor - 1), leaf.origin().offsetBy(VoxelLeaf::DIM - 1))};
}

void list_parts_of_leaf(const VoxelLevel& fine, std::uint32_t leaf_number, std::int32_t factor,
                        std::vector<PartOfParent>& parts) {
  const VoxelLeaf& leaf = fine.leaves()[leaf_number];
  const VoxelIndex low = parent_of_voxel(leaf.origin(), factor);
  const VoxelIndex high = parent_of_voxel(leaf.origin().offsetBy(VoxelLeaf::DIM - 1), factor);
  for (auto parent = openvdb::CoordBBox(low, high).beginXYZ(); parent; ++parent) {
    const ChildBox box = box_of_children(leaf, *parent, factor);
    if (has_voxel_in(leaf, box.low, box.high)) parts.push_back({key_of_voxel(*parent), leaf_number});
  }
}

// The parts of all parents, sorted by parent, then leaf.
std::vector<PartOfParent> list_parts(const VoxelLevel& fine, std::int32_t factor) {
  constexpr std::size_t kLeavesPerRange = 256;
  const std::size_t num_leaves = fine.leaves().size();
  std::vector<std::vector<PartOfParent>> ranges((num_leaves + kLeavesPerRange - 1) / kLeavesPerRange);
  parallel_for(ranges.size(), [&](std::size_t i) {
    const std::size_t end = std::min(num_leaves, (i + 1) * kLeavesPerRange);
    for (std::size_t leaf = i * kLeavesPerRange; leaf < end; ++leaf) {
      list_parts_of_leaf(fine, static_cast<std::uint32_t>(leaf), factor, ranges[i]);
    }
  });

  std::vector<PartOfParent> parts;
  for (const auto& range : ranges) parts.insert(parts.end(), range.begin(), range.end());
  parallel_sort(parts, std::less<>());
  return parts;
}

// Where each parent's parts begin, and the end of all.
std::vector<std::uint32_t> first_parts(const std::vector<PartOfParent>& parts) {
  std::vector<std::uint32_t> first;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i == 0 || parts[i].parent != parts[i - 1].parent) first.push_back(static_cast<std::uint32_t>(i));
  }
  first.push_back(static_cast<std::uint32_t>(parts.size()));
  return first;
}

// Adds up each leaf's voxels, then the leaves, in their order: the same sums for any number of threads.
ParentSums sums_of_parts(const VoxelLevel& fine, std::span<const PartOfParent> parts, const VoxelIndex& parent,
                         std::int32_t factor) {
  const Eigen::Vector3d center = center_of_voxel(parent, fine.voxel_size() * factor);
  ParentSums total;
  for (const PartOfParent& part : parts) {
    ParentSums sums;
    const VoxelLeaf& leaf = fine.leaves()[part.leaf];
    const ChildBox box = box_of_children(leaf, parent, factor);
    for_each_voxel_in(leaf, box.low, box.high, [&](const VoxelIndex& child, std::size_t number) {
      sums.add(sums_of_child(fine, number, child, center));
    });
    total.add(sums);
  }
  return total;
}

VoxelRecord record_of(const ParentSums& sums, const VoxelIndex& parent, double voxel_size) {
  Moments moments = moments_of(sums.points);
  moments.mean += center_of_voxel(parent, voxel_size);

  VoxelRecord record;
  set_moments(record, moments, parent, voxel_size);
  set_color(record, sums.color / sums.points.count());
  return record;
}

ParentVoxel make_parent(const VoxelLevel& fine, std::span<const PartOfParent> parts, std::int32_t factor,
                        double voxel_size) {
  const VoxelIndex parent = voxel_of_key(parts.front().parent);
  const ParentSums sums = sums_of_parts(fine, parts, parent, factor);
  return {record_of(sums, parent, voxel_size), static_cast<float>(sums.intensity / sums.points.count()),
          sums.first_epoch, sums.last_epoch};
}

// Adds parents to the level above, in the order of their keys.
class ParentAssembly {
 public:
  ParentAssembly(const VoxelLevel& fine, std::int32_t factor, double voxel_size, std::size_t num_parents)
      : channels_(fine.channels()),
        votes_(channels_.labels.empty() ? std::vector<LabelVotes>() : votes_for_parents(fine, factor)),
        election_(votes_),
        assembly_(voxel_size, num_parents) {}
  ParentAssembly(const ParentAssembly&) = delete;
  ParentAssembly& operator=(const ParentAssembly&) = delete;

  void add(VoxelKey key, const ParentVoxel& parent) {
    [[maybe_unused]] const bool in_order = assembly_.add(voxel_of_key(key), parent.record);
    VoxelChannels& channels = assembly_.channels();
    if (!channels_.intensities.empty()) channels.intensities.push_back(parent.intensity);
    if (!channels_.labels.empty()) channels.labels.push_back(election_.winner(key));
    if (!channels_.first_epochs.empty()) channels.first_epochs.push_back(parent.first_epoch);
    if (!channels_.last_epochs.empty()) channels.last_epochs.push_back(parent.last_epoch);
  }

  VoxelLevel finish() { return assembly_.finish(); }

 private:
  const VoxelChannels& channels_;  // of the level below
  std::vector<LabelVotes> votes_;
  LabelElection election_;  // of votes_
  VoxelAssembly assembly_;
};

}  // namespace

VoxelLevel coarsen(const VoxelLevel& fine, std::int32_t factor) {
  return coarsen(fine, factor, factor / voxels_per_metre(fine.voxel_size()));
}

VoxelLevel coarsen(const VoxelLevel& fine, std::int32_t factor, double voxel_size) {
  constexpr std::size_t kParentsAtOnce = std::size_t{1} << 16;  // between being made and being added
  const std::vector<PartOfParent> parts = list_parts(fine, factor);
  const std::vector<std::uint32_t> first = first_parts(parts);
  const std::size_t num_parents = first.size() - 1;
  const auto parts_of = [&](std::size_t i) { return std::span(parts).subspan(first[i], first[i + 1] - first[i]); };

  ParentAssembly assembly(fine, factor, voxel_size, num_parents);
  std::vector<ParentVoxel> parents;
  for (std::size_t begin = 0; begin < num_parents; begin += kParentsAtOnce) {
    parents.resize(std::min(kParentsAtOnce, num_parents - begin));
    parallel_for(
        parents.size(), [&](std::size_t i) { parents[i] = make_parent(fine, parts_of(begin + i), factor, voxel_size); },
        64);
    for (std::size_t i = 0; i < parents.size(); ++i) assembly.add(parts_of(begin + i).front().parent, parents[i]);
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
