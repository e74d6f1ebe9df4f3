// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel.h"

#include <sstream>
#include <stdexcept>

namespace vdbmap {

double voxels_per_metre(double voxel_size) {
  constexpr double kVoxelsPerLeaf = 8;
  const double per_tile = kVoxelsPerLeaf * std::round(kTileSize / kVoxelsPerLeaf / voxel_size);
  const bool in_range = voxel_size >= 0.001 && per_tile > 0;  // false for NaN
  if (!in_range || std::abs(per_tile * voxel_size - kTileSize) > 1e-9 * kTileSize) {
    std::ostringstream message;
    message << "voxel size is " << voxel_size << " m, " << kAllowedVoxelSizes;
    throw std::invalid_argument(message.str());
  }
  return per_tile / kTileSize;
}

std::int32_t level_factor(double fine_voxel_size, double coarse_voxel_size) {
  const double factor = std::round(coarse_voxel_size / fine_voxel_size);
  if (!(factor >= 2) || std::abs(factor * fine_voxel_size - coarse_voxel_size) > 1e-9 * coarse_voxel_size) {
    std::ostringstream message;
    message << "level of " << coarse_voxel_size << " m is not a whole multiple of the " << fine_voxel_size
            << " m level below";
    throw std::invalid_argument(message.str());
  }
  return static_cast<std::int32_t>(factor);
}

}  // namespace vdbmap
