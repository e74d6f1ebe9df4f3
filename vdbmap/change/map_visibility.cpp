// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/change/map_visibility.h"

namespace vdbmap {

Visibility find_visibility(const VoxelMap& map, const CloudSource& clouds, const RayTrust& trust) {
  RayEvidence evidence({&map}, trust);
  clouds([&](const PosedCloud& posed) { evidence.add(rays_of(posed, map.frame.anchor)); });
  Visibility visibility;
  visibility.voxel_size = map.finest().voxel_size();
  visibility.seen_empty = evidence.seen_empty();
  visibility.passes = evidence.passes(0);
  for (const VoxelRecord& record : map.finest().records()) visibility.hits.push_back(record.count);
  return visibility;
}

}  // namespace vdbmap
