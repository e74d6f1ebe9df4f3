// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

/// Simple polygons on the ground.
namespace vdbmap::parking {

/// Area [m^2]: above 0 where the corners go against the clock.
double signed_area(std::span<const Eigen::Vector2d> outline);

/// Whether a place lies inside.
bool contains(std::span<const Eigen::Vector2d> outline, const Eigen::Vector2d& place);

/// Why corners are no outline of a parking space: "crosses itself", "has no area", ...; empty where they are one.
std::string problem_of_outline(std::span<const Eigen::Vector2d> outline);

/// The smallest convex polygon around places, against the clock (Andrew 1979).
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> places);

}  // namespace vdbmap::parking
