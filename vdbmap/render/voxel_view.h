// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "vdbmap/render/camera.h"
#include "vdbmap/render/image.h"
#include "vdbmap/render/voxel_colors.h"

namespace vdbmap {

/// A picture of voxels and how far each pixel's middle is from the camera.
struct VoxelView {
  Image image;
  std::vector<float> distances;  ///< [m] along the ray, row by row; infinity where there is no voxel

  float distance_at(int x, int y) const {
    return distances[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width()) +
                     static_cast<std::size_t>(x)];
  }
};

/// Voxels of one size that are drawn.
struct VoxelLayer {
  const VoxelLevel& level;
  const VoxelColors& colors;
};

/// Draws the voxels of a level as lit cubes, anti-aliased at their edges; the same pixels for any number of threads.
VoxelView view_voxels(const VoxelLevel& level, const VoxelColors& colors, const Camera& camera);

/// The same of several levels, each of another part of the scene. Voxels cast their shadows on those of their own
/// level.
VoxelView view_layers(std::span<const VoxelLayer> layers, const Camera& camera);

}  // namespace vdbmap
