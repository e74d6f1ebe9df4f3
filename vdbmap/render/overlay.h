// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "vdbmap/render/camera.h"
#include "vdbmap/render/voxel_view.h"

namespace vdbmap {

/// Something drawn over the voxels [m, local frame].
struct PathOverlay {
  std::string name;
  std::vector<std::vector<Eigen::Vector3d>> pieces;  ///< lines between gaps
  Rgb8 color;
};
struct PointsOverlay {
  std::string name;
  std::vector<Eigen::Vector3d> points;
  Rgb8 color;
};

/// Draws a path as a line with a dot at each place; behind voxels it is pale.
void draw_path(VoxelView& view, const Camera& camera, const PathOverlay& path, double width);

/// Draws points as small discs where no voxel hides them; one of a surface is not hidden by its own voxels.
void draw_points(VoxelView& view, const Camera& camera, const PointsOverlay& points, double voxel_size);

}  // namespace vdbmap
