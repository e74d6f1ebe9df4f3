// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "parking/segmentation/network_weights.h"
#include "parking/segmentation/surface_class.h"
#include "vdbmap/core/point_cloud.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap::parking {

/// How a level is segmented.
struct SegmentOptions {
  /// Larger levels are cut into windows of whole tiles, so that memory stays some 700 bytes for so many voxels and for
  /// those up to 24 m around, which is as far as the network sees.
  std::size_t voxels_at_once = 4'000'000;
};

/// The class of each voxel of a level of 0.1 m, in the order of its records: the one that scores highest. Windows
/// change nothing. Throws std::invalid_argument for another voxel size.
std::vector<SurfaceClass> segment(const VoxelLevel& finest, const NetworkWeights& network,
                                  const SegmentOptions& options = {});

/// Labels all voxels of a map with SemanticKITTI's class that stands for theirs (semantic_kitti_label()); labels that
/// it had are gone. Voxels smaller than 0.1 m have the class of the voxel of 0.1 m around them, larger ones that of
/// most of their points. Throws std::invalid_argument unless 0.1 m is a multiple of the finest voxel size.
void label_map(VoxelMap& map, const NetworkWeights& network, const SegmentOptions& options = {});

/// The same labels for the points of a cloud or scan by itself, z upwards: each has that of the voxel of 0.1 m that it
/// lies in; points that no voxel can hold, thousands of kilometres from the others, have none (kNoLabel).
std::vector<std::int32_t> point_labels(const PointCloud& cloud, const NetworkWeights& network,
                                       const SegmentOptions& options = {});

}  // namespace vdbmap::parking
