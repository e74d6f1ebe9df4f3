// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vdbmap/change/change_regions.h"
#include "vdbmap/change/map_diff.h"
#include "vdbmap/core/voxel_map.h"
#include "vdbmap/io/poses/trajectory_file.h"
#include "vdbmap/render/camera_choice.h"
#include "vdbmap/render/image.h"
#include "vdbmap/render/voxel_colors.h"

namespace vdbmap {

struct RenderOptions {
  ImageSize size;  ///< [pixels] each side 1 to kMaxImageSize
  View view = View::kOrbit;
  std::optional<ColorBy> color_by;  ///< without: the colours of the points where the map has them, else height
  /// Numbers of the camera as choose_camera() takes them, places in the original system; none: chosen.
  std::vector<double> camera;
  double voxel_size = 0;       ///< [m] of the level that is drawn; 0: the finest that is no dust
  bool has_decoration = true;  ///< grid, scale bar, north arrow and legend
};

/// What is drawn over the map, in the original system.
struct NamedTrajectory {
  std::string name;
  Trajectory poses;
};
struct NamedPoints {
  std::string name;
  std::vector<Eigen::Vector3d> points;
};
struct RenderOverlays {
  const MapDiff* diff = nullptr;      ///< whose later map this is: draws what vanished too, and colours by change
  std::vector<ChangeRegion> regions;  ///< outlined with their numbers
  std::vector<NamedTrajectory> trajectories;  ///< red, green, blue, ... as in figure 8 of the paper
  std::vector<NamedPoints> points;            ///< magenta, cyan, ... as in its figures 5 to 7
};

struct RenderResult {
  Image image;
  bool is_camera_in_voxel = false;  ///< the picture shows what is seen from inside of it
};

/// The camera of a picture of the map, chosen by its finest level where options say nothing. Throws as render().
Camera camera_of(const VoxelMap& map, const RenderOptions& options, const RenderOverlays& overlays);

/// A map in two parts that have no place in common, one of which may have no voxels: each is drawn by its finest level,
/// in the colours of a level of all of it.
struct NearAndFar {
  const VoxelMap& near;
  const VoxelMap& far;
  const VoxelMap& all;
};

/// Draws what lies near the camera in finer voxels than what lies far. Without a diff; the level is not chosen by
/// options. Throws as render().
RenderResult render(const NearAndFar& parts, const Camera& camera, const RenderOptions& options,
                    const RenderOverlays& overlays);

/// Draws a map without a display: voxels as cubes in sunlight under an open sky. The same pixels for any number of
/// threads. Throws std::invalid_argument for a size out of range, a level or attribute that the map has not, a map
/// without voxels, a diff of other maps and an impossible camera.
RenderResult render(const VoxelMap& map, const RenderOptions& options = {}, const RenderOverlays& overlays = {});

}  // namespace vdbmap
