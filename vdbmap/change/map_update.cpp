// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/change/map_update.h"

#include <stdexcept>
#include <vector>

#include "vdbmap/core/map_builder.h"

namespace vdbmap {
namespace {

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

void check_visibility(const Visibility& visibility, const VoxelLevel& level) {
  if (visibility.voxel_size != level.voxel_size() || visibility.hits.size() != level.size() ||
      visibility.passes.size() != level.size()) {
    throw std::invalid_argument("the visibility is that of another map");
  }
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
  const VoxelLevel& level = map.finest();
  const VoxelFates fates(
      level, drive.finest(),
      find_seen_through(level, evidence.passes(0), evidence.pass_times(0), drive.finest(), presence, options.gone),
      find_seen_through(drive.finest(), evidence.passes(1), evidence.pass_times(1), drive.finest(), presence,
                        options.moved),
      options.trust);
  UpdatedMap updated{voxels_after(map, drive, fates), {}, fates.counts()};
  const VoxelTree seen_empty = evidence.seen_empty();
  updated.visibility = visibility_after(updated.map.finest(), level, before, drive.finest(),
                                        {evidence.passes(0), evidence.passes(1), seen_empty}, fates);
  return updated;
}

}  // namespace vdbmap
