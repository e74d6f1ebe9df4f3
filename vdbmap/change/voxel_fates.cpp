// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/change/voxel_fates.h"

#include <cmath>
#include <functional>
#include <utility>

#include "vdbmap/change/held_surface.h"
#include "vdbmap/core/map_merge.h"
#include "vdbmap/core/map_subset.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/core/voxel_block.h"

namespace vdbmap {
namespace {

std::size_t number_in(const VoxelLevel& level, const VoxelRecord* record) {
  return static_cast<std::size_t>(record - level.records().data());
}

// Whether the drive's points lie on another surface than the map's: the distance of their means across the surface,
// against what it is known to.
bool differ(const VoxelRecord& map, const VoxelRecord& drive, double voxel_size, const RayTrust& trust) {
  constexpr double kDiffering = 3;  // standard deviations
  const HeldSurface a = held_surface(map, voxel_size);
  const HeldSurface b = held_surface(drive, voxel_size);
  if (!a.has_normal()) return false;
  const double distance = a.normal.dot(b.mean - a.mean);
  const double of_means = a.variance / map.count + b.variance / drive.count;
  const double sigma = std::sqrt(of_means + trust.position_sigma * trust.position_sigma);
  return std::abs(distance) > kDiffering * sigma;
}

// Without colours of its own a map counts as uncoloured still: where it is merged, voxels of both have those of the
// other.
void paint(VoxelMap& map, const Eigen::Vector3d& linear_rgb) {
  for (VoxelRecord& record : map.levels.front().records()) set_color(record, linear_rgb);
}

// The voxels of records that are left out.
VoxelTree voxels_left_out(const VoxelLevel& level, const std::function<bool(std::size_t)>& is_wanted) {
  LargeVector<VoxelLeaf> leaves;
  for (const VoxelLeaf& leaf : level.leaves()) {
    VoxelLeaf::NodeMaskType mask;
    for_each_voxel(leaf, [&](const VoxelIndex& voxel, std::size_t record) {
      if (is_wanted(record)) mask.setOn(VoxelLeaf::coordToOffset(voxel));
    });
    if (mask.isOff()) continue;
    VoxelLeaf& made = leaves.emplace_back(leaf.origin(), false, false);
    made.setValueMask(mask);
  }
  return VoxelTree(std::move(leaves));
}

// Rays of before and of the drive, of the voxels of the map as it is now.
void count_rays(Visibility& visibility, const VoxelLevel& after, const VoxelLevel& map,
                const std::optional<Visibility>& before, const VoxelLevel& drive, const RaysOfDrive& rays,
                const VoxelFates& fates) {
  visibility.hits.resize(after.size());
  visibility.passes.resize(after.size());
  parallel_for(
      after.leaves().size(),
      [&](std::size_t i) {
        const VoxelFinder in_map(map);
        const VoxelFinder in_drive(drive);
        for_each_voxel(after.leaves()[i], [&](const VoxelIndex& voxel, std::size_t record) {
          const VoxelRecord* old = in_map.find(voxel);
          const VoxelRecord* now = in_drive.find(voxel);
          if (old && fates.stays(number_in(map, old))) {
            const std::size_t number = number_in(map, old);
            if (before) visibility.hits[record] += before->hits[number];
            visibility.passes[record] += (before ? before->passes[number] : 0) + rays.map_passes[number];
          }
          if (now && fates.is_still(number_in(drive, now))) {
            visibility.hits[record] += now->count;
            visibility.passes[record] += rays.drive_passes[number_in(drive, now)];
          }
        });
      },
      64);
}

}  // namespace

VoxelFates::VoxelFates(const VoxelLevel& map, const VoxelLevel& drive, const std::vector<std::uint8_t>& gone,
                       std::vector<std::uint8_t> moved, const RayTrust& trust)
    : map_(map), drive_(drive), moved_(std::move(moved)), fates_(map.size()) {
  parallel_for(
      map_.leaves().size(),
      [&](std::size_t i) {
        const VoxelFinder finder(drive_);
        for_each_voxel(map_.leaves()[i], [&](const VoxelIndex& voxel, std::size_t record) {
          fates_[record] = fate_of(voxel, gone[record] != 0, map_.records()[record], finder, trust);
        });
      },
      64);
}

VoxelFates::Fate VoxelFates::fate_of(const VoxelIndex& voxel, bool is_gone, const VoxelRecord& record,
                                     const VoxelFinder& finder, const RayTrust& trust) const {
  const VoxelRecord* drive = finder.find(voxel);
  const bool is_still_there = drive && is_still(number_in(drive_, drive));
  if (!is_still_there) return is_gone ? Fate::kGone : Fate::kUnseen;
  const bool is_other = is_gone || differ(record, *drive, map_.voxel_size(), trust);
  return is_other ? Fate::kReplaced : Fate::kConfirmed;
}

UpdateCounts VoxelFates::counts(const openvdb::CoordBBox& box) const {
  UpdateCounts counts;
  for (const VoxelLeaf& leaf : map_.leaves()) {
    if (!box.isInside(leaf.origin())) continue;
    for_each_voxel(leaf, [&](const VoxelIndex& /*voxel*/, std::size_t record) {
      counts.unseen += fates_[record] == Fate::kUnseen;
      counts.confirmed += fates_[record] == Fate::kConfirmed;
      counts.replaced += fates_[record] == Fate::kReplaced;
      counts.gone += fates_[record] == Fate::kGone;
    });
  }
  std::size_t still = 0;
  for (const VoxelLeaf& leaf : drive_.leaves()) {
    if (!box.isInside(leaf.origin())) continue;
    for_each_voxel(leaf, [&](const VoxelIndex& /*voxel*/, std::size_t record) {
      const std::size_t num_points = drive_.records()[record].count;
      counts.num_points += num_points;
      counts.moved += moved_[record];
      counts.num_moved_points += moved_[record] * num_points;
      still += moved_[record] == 0;
    });
  }
  counts.added = still - counts.confirmed - counts.replaced;
  return counts;
}

VoxelMap voxels_after(const VoxelMap& map, const VoxelMap& drive, const VoxelFates& fates) {
  VoxelMap still = keep_voxels(drive, [&](std::size_t i) { return fates.is_still(i); });
  if (map.has_color && !drive.has_color) paint(still, kUnknownColor);
  return merge_maps(keep_voxels(map, [&](std::size_t i) { return fates.stays(i); }), still);
}

Visibility visibility_after(const VoxelLevel& after, const VoxelLevel& map, const std::optional<Visibility>& before,
                            const VoxelLevel& drive, const RaysOfDrive& rays, const VoxelFates& fates) {
  const VoxelTree& occupied = after.tree();
  const VoxelTree left = united(voxels_left_out(map, [&](std::size_t i) { return !fates.stays(i); }),
                                voxels_left_out(drive, [&](std::size_t i) { return !fates.is_still(i); }), occupied);
  const VoxelTree seen = united(rays.seen_empty, left, occupied);
  Visibility visibility;
  visibility.voxel_size = after.voxel_size();
  visibility.seen_empty = before ? united(before->seen_empty, seen, occupied) : seen;
  count_rays(visibility, after, map, before, drive, rays, fates);
  return visibility;
}

VoxelTree united(const VoxelTree& a, const VoxelTree& b, const VoxelTree& without) {
  LargeVector<VoxelLeaf> leaves;
  const auto add = [&](VoxelLeaf leaf) {
    auto mask = leaf.getValueMask();
    if (const VoxelLeaf* occupied = without.find_leaf(leaf.origin())) mask -= occupied->getValueMask();
    if (mask.isOff()) return;
    leaf.setValueMask(mask);
    leaves.push_back(std::move(leaf));
  };
  auto next_b = b.leaves().begin();
  const auto key = [](const VoxelLeaf& leaf) { return key_of_voxel(leaf.origin()); };
  for (const VoxelLeaf& leaf : a.leaves()) {
    while (next_b != b.leaves().end() && key(*next_b) < key(leaf)) add(*next_b++);
    VoxelLeaf both = leaf;
    if (next_b != b.leaves().end() && key(*next_b) == key(leaf)) {
      both.setValueMask(typename VoxelLeaf::NodeMaskType(leaf.getValueMask() | (next_b++)->getValueMask()));
    }
    add(both);
  }
  for (; next_b != b.leaves().end(); ++next_b) add(*next_b);
  return VoxelTree(std::move(leaves));
}

}  // namespace vdbmap
