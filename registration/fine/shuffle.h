// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace vdbmap::registration {

/// The points in a fixed order that has nothing to do with where they lie.
///
/// A scan's own order does: a ray that sweeps towards a cube enters it first with the points whose noise carries them
/// ahead. The first point of every cube of a scan in its own order therefore lies behind its surface on average, a
/// tenth of the noise, and all of them together move an alignment by many times its uncertainty.
std::vector<Eigen::Vector3d> shuffled(std::span<const Eigen::Vector3d> points);

}  // namespace vdbmap::registration
