// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "vdbmap/core/voxel_level.h"
#include "vdbmap/render/camera.h"

namespace vdbmap {

/// From where a map is seen.
enum class View {
  kPlan,         ///< from straight above, north up
  kPerspective,  ///< from above the street, along it
  kOrbit,        ///< from outside, with all of the map in the picture
};

/// Where the voxels of a level are [m, local frame], but for a few stray ones.
struct SceneExtent {
  Eigen::AlignedBox3d box;
  double heading_deg = 0;  ///< of its longest direction in the plane, to the left of the x axis
};
SceneExtent scene_extent(const VoxelLevel& level);

/// The camera of a view. `numbers` says which, in the local frame; without any it is chosen so that the picture is
/// good.
///
/// * plan: x and y of the middle, width of the picture [m]
/// * perspective: x, y, z of the eye [m], heading (to the left of the x axis), elevation [deg][, field of view [deg]]
/// * orbit: heading, elevation [deg][, distance from the middle of the map [m]]
///
/// With a `path` [m], the perspective follows it. A perspective of given numbers does not depend on the level. Throws
/// std::invalid_argument for another count and impossible numbers.
Camera choose_camera(const VoxelLevel& level, View view, const ImageSize& size, std::span<const double> numbers = {},
                     std::span<const Eigen::Vector3d> path = {});

}  // namespace vdbmap
