// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "parking/occupancy/occupancy_record.h"
#include "vdbmap/render/camera.h"
#include "vdbmap/render/image.h"
#include "vdbmap/render/voxel_colors.h"

namespace vdbmap::parking {

/// Red, green, grey.
Rgb8 color_of(SpaceState state);
inline constexpr Rgb8 kCandidateColor = rgb8(0x2f6db5);
inline constexpr Rgb8 kChangeColor = rgb8(0xffd21f);

/// How a street lies on a page.
struct StreetFrame {
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();  ///< unit, to the right on the page; up is to its left
  Eigen::Vector2d low = Eigen::Vector2d::Zero();     ///< corners of the box around all spaces [m, along and up]
  Eigen::Vector2d high = Eigen::Vector2d::Zero();

  Eigen::Vector2d up() const { return {-along.y(), along.x()}; }
  Eigen::Vector2d coordinates_of(const Eigen::Vector2d& place) const { return {place.dot(along), place.dot(up())}; }
  Eigen::Vector2d place_at(const Eigen::Vector2d& coordinates) const {
    return coordinates.x() * along + coordinates.y() * up();
  }
  double heading_deg() const;  ///< of the way up, to the left of +x
};

/// The frame whose first direction is that in which the spaces are spread, towards +x.
StreetFrame street_frame(const std::vector<ParkingSpace>& spaces);

/// Whether its state is known in both epochs and another than before.
bool has_changed(const SpaceOccupancy& state);

/// Draws the street from above around `middle` [m, along and up], `width` [m] of it, with the spaces; their ids where
/// these fit.
Image draw_plan(const OccupancyRecord& record, const VoxelLevel& scene, const VoxelColors& colors,
                const StreetFrame& frame, const Eigen::Vector2d& middle, double width, const ImageSize& size);

/// Draws it from above one end of the street, along it.
Image draw_perspective(const OccupancyRecord& record, const VoxelLevel& scene, const VoxelColors& colors,
                       const StreetFrame& frame, const ImageSize& size);

}  // namespace vdbmap::parking
