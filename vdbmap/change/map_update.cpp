// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/change/map_update.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "vdbmap/core/map_builder.h"
#include "vdbmap/core/map_merge.h"
#include "vdbmap/core/map_subset.h"
#include "vdbmap/core/option_check.h"
#include "vdbmap/core/voxel_block.h"

namespace vdbmap {
namespace {

// What becomes of a voxel of the map.
enum class Fate : std::uint8_t { kUnseen, kConfirmed, kReplaced, kGone };

BuildOptions build_options(const VoxelMap& map, const UpdateOptions& options) {
  BuildOptions build;
  build.voxel_sizes.clear();
  for (const VoxelLevel& level : map.levels) build.voxel_sizes.push_back(level.voxel_size());
  build.anchor = map.frame.anchor;
  build.epsg = map.frame.epsg;
  build.epoch = options.epoch;
  return build;
}

VoxelMap map_of_drive(const VoxelMap& map, const CloudSource& clouds, const UpdateOptions& options) {
  MapBuilder builder(build_options(map, options));
  clouds([&](const PosedCloud& posed) { builder.add(posed.cloud, posed.map_from_cloud); });
  VoxelMap drive = builder.finish();
  drive.label_scheme = map.label_scheme;
  return drive;
}

// Whether the drive's points lie on another surface than the map's: the distance of their means across the surface,
// against what it is known to.
bool differ(const VoxelRecord& map, const VoxelRecord& drive, double voxel_size, const RayTrust& trust) {
  constexpr double kSigmas = 3;
  const HeldSurface a = held_surface(map, voxel_size);
  const HeldSurface b = held_surface(drive, voxel_size);
  if (!a.has_normal()) return false;
  const double distance = a.normal.dot(b.mean - a.mean);
  const double of_means = a.variance / map.count + b.variance / drive.count;
  const double sigma = std::sqrt(of_means + trust.position_sigma * trust.position_sigma);
  return std::abs(distance) > kSigmas * sigma;
}

class Update {
 public:
  Update(const VoxelMap& map, const VoxelMap& drive, const RayEvidence& evidence, const std::vector<TimeBins>& presence,
         const UpdateOptions& options)
      : map_(map.finest()),
        drive_(drive.finest()),
        options_(options),
        moved_(find_seen_through(drive_, evidence.passes(1), evidence.pass_times(1), drive_, presence, options.moved)),
        gone_(find_seen_through(map_, evidence.passes(0), evidence.pass_times(0), drive_, presence, options.gone)) {
    fates_.resize(map_.size());
    parallel_for(
        map_.leaves().size(),
        [&](std::size_t i) {
          const VoxelFinder finder(drive_);
          for_each_voxel(map_.leaves()[i], [&](const VoxelIndex& voxel, std::size_t record) {
            fates_[record] = fate_of(voxel, record, finder);
          });
        },
        64);
  }

  bool stays(std::size_t record) const { return fates_[record] == Fate::kUnseen || fates_[record] == Fate::kConfirmed; }
  bool is_still(std::size_t drive_record) const { return moved_[drive_record] == 0; }

  UpdateCounts counts() const {
    UpdateCounts counts;
    for (const Fate fate : fates_) {
      counts.unseen += fate == Fate::kUnseen;
      counts.confirmed += fate == Fate::kConfirmed;
      counts.replaced += fate == Fate::kReplaced;
      counts.gone += fate == Fate::kGone;
    }
    std::size_t still = 0;
    for (std::size_t i = 0; i < drive_.size(); ++i) {
      counts.num_points += drive_.records()[i].count;
      counts.moved += moved_[i];
      counts.num_moved_points += moved_[i] * std::size_t{drive_.records()[i].count};
      still += moved_[i] == 0;
    }
    counts.added = still - counts.confirmed - counts.replaced;
    return counts;
  }

 private:
  Fate fate_of(const VoxelIndex& voxel, std::size_t record, const VoxelFinder& finder) const {
    const VoxelRecord* drive = finder.find(voxel);
    const bool is_still_there = drive && moved_[static_cast<std::size_t>(drive - drive_.records().data())] == 0;
    const bool is_gone = gone_[record] != 0;
    if (!is_still_there) return is_gone ? Fate::kGone : Fate::kUnseen;
    const bool is_other = is_gone || differ(map_.records()[record], *drive, map_.voxel_size(), options_.trust);
    return is_other ? Fate::kReplaced : Fate::kConfirmed;
  }

  const VoxelLevel& map_;
  const VoxelLevel& drive_;
  const UpdateOptions& options_;
  std::vector<std::uint8_t> moved_;  // a record of the drive
  std::vector<std::uint8_t> gone_;   // a record of the map
  std::vector<Fate> fates_;
};

void check_visibility(const Visibility& visibility, const VoxelLevel& level) {
  if (visibility.voxel_size != level.voxel_size() || visibility.hits.size() != level.size() ||
      visibility.passes.size() != level.size()) {
    throw std::invalid_argument("the visibility is that of another map");
  }
}

// Without colours of its own a map counts as uncoloured still: where it is merged, voxels of both have those of the
// other.
void paint(VoxelMap& map, const Eigen::Vector3d& linear_rgb) {
  for (VoxelRecord& record : map.levels.front().records()) set_color(record, linear_rgb);
}

// Leaves of two trees together, without what is occupied now.
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

// The voxels of records that are left out.
VoxelTree voxels_of(const VoxelLevel& level, const std::function<bool(std::size_t)>& is_wanted) {
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
void count_rays(UpdatedMap& updated, const VoxelMap& map, const std::optional<Visibility>& before,
                const VoxelMap& drive, const RayEvidence& evidence, const Update& update) {
  const VoxelLevel& level = updated.map.finest();
  Visibility& visibility = updated.visibility;
  visibility.hits.resize(level.size());
  visibility.passes.resize(level.size());
  const auto number_of = [](const VoxelRecord* record, const VoxelMap& source) {
    return static_cast<std::size_t>(record - source.finest().records().data());
  };
  parallel_for(
      level.leaves().size(),
      [&](std::size_t i) {
        const VoxelFinder in_map(map.finest());
        const VoxelFinder in_drive(drive.finest());
        for_each_voxel(level.leaves()[i], [&](const VoxelIndex& voxel, std::size_t record) {
          const VoxelRecord* old = in_map.find(voxel);
          const VoxelRecord* now = in_drive.find(voxel);
          if (old && update.stays(number_of(old, map))) {
            const std::size_t number = number_of(old, map);
            if (before) visibility.hits[record] += before->hits[number];
            visibility.passes[record] += (before ? before->passes[number] : 0) + evidence.passes(0)[number];
          }
          if (now && update.is_still(number_of(now, drive))) {
            visibility.hits[record] += now->count;
            visibility.passes[record] += evidence.passes(1)[number_of(now, drive)];
          }
        });
      },
      64);
}

}  // namespace

void UpdateOptions::check() const {
  trust.check();
  gone.check();
  moved.check();
}

UpdatedMap update_map(const VoxelMap& map, const std::optional<Visibility>& before, const CloudSource& clouds,
                      const UpdateOptions& options) {
  options.check();
  if (before) check_visibility(*before, map.finest());
  const VoxelMap drive = map_of_drive(map, clouds, options);
  RayEvidence evidence({&map, &drive}, options.trust);
  const std::vector<TimeBins> presence = presence_of(drive, clouds);
  clouds([&](const PosedCloud& posed) { evidence.add(rays_of(posed, map.frame.anchor)); });
  const Update update(map, drive, evidence, presence, options);

  UpdatedMap updated;
  updated.counts = update.counts();
  VoxelMap still = keep_voxels(drive, [&](std::size_t i) { return update.is_still(i); });
  if (map.has_color && !drive.has_color) paint(still, kUnknownColor);
  updated.map = merge_maps(keep_voxels(map, [&](std::size_t i) { return update.stays(i); }), still);
  const VoxelTree& occupied = updated.map.finest().tree();
  const VoxelTree left =
      united(voxels_of(map.finest(), [&](std::size_t i) { return !update.stays(i); }),
             voxels_of(drive.finest(), [&](std::size_t i) { return !update.is_still(i); }), occupied);
  const VoxelTree seen = united(evidence.seen_empty(), left, occupied);
  updated.visibility.voxel_size = map.finest().voxel_size();
  count_rays(updated, map, before, drive, evidence, update);
  updated.visibility.seen_empty = before ? united(before->seen_empty, seen, occupied) : seen;
  return updated;
}

}  // namespace vdbmap
