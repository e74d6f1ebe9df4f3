// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "tools/simulator/pulse.h"
#include "vdbmap/core/point_cloud.h"

namespace vdbmap::simulator {

/// The light of a day.
struct Daylight {
  Eigen::Vector3d to_sun;                ///< length 1
  Eigen::Array3d sun = {1.5, 1.4, 1.2};  ///< linear light of a white surface that faces the sun
  Eigen::Array3d sky = {.42, .48, .58};  ///< of one that faces the sky
};

/// The sun of an epoch, some time between morning and afternoon.
Daylight make_daylight(std::uint64_t seed, int epoch);

/// What a camera sees at a point of a surface: its texture in sun or shadow, and a little noise.
Rgb16 color_of(const SceneView& view, const Daylight& light, const Eigen::Vector3d& point, const Echo& echo,
               RayRandom& random);

}  // namespace vdbmap::simulator
