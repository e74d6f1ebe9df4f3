// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace vdbmap::registration {

/// The share of surfaces that hold, each weighted by the leverage of its unit normal on the translation,
/// n^T (sum n n^T)^-1 n: so three directions of surfaces count alike, however many there are of each. 0 of none.
double balanced_share(std::span<const Eigen::Vector3d> normals, const std::vector<bool>& holds);

}  // namespace vdbmap::registration
