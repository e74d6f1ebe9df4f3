// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "vdbmap/render/camera.h"
#include "vdbmap/render/color_scale.h"

namespace vdbmap {

/// Where the light comes from: the sun over the viewer's left shoulder, as maps are lit, and the whole sky.
struct Lighting {
  Eigen::Vector3d to_sun;      ///< unit
  double sky_reach = 2.5;      ///< [m] what is nearer hides the sky
  double shadow_reach = 60.0;  ///< [m] what is nearer hides the sun

  static Lighting for_camera(const Camera& camera);
};

/// What reaches a voxel.
struct LightOnVoxel {
  double sky_share = 1;      ///< 0..1 of the sky that its surroundings leave free (ambient occlusion)
  bool is_in_shade = false;  ///< whether something hides the sun
};

/// How many rays look for the sky. Of voxels smaller than a pixel each sends one half of them, neighbours the other
/// half.
enum class SkyRays { kAll, kEvenHalf, kOddHalf };

/// Sends rays from a voxel whose surface has this normal.
LightOnVoxel light_on_voxel(const RayCaster& caster, const Eigen::Vector3d& center, double voxel_size,
                            const Eigen::Vector3d& normal, const Lighting& lighting, SkyRays rays = SkyRays::kAll);

/// Sunlight and skylight that fall on a face with this normal, as a factor of its colour.
LinearColor light_on_face(const LightOnVoxel& voxel, const Eigen::Vector3d& normal, const Lighting& lighting);

/// Normal for shading the face of a voxel: the stored one, turned to the viewer, as far as it can be relied on.
Eigen::Vector3d shading_normal(const VoxelRecord& record, VoxelFace face, const Eigen::Vector3d& to_viewer);

/// What is seen where no voxel is: a soft sky, haze below the horizon; paper in a view from straight above.
LinearColor background(const Camera& camera, const Eigen::Vector3d& direction);

/// The colour of the haze at the horizon, into which distant voxels fade.
LinearColor haze_color();

}  // namespace vdbmap
