// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include <Eigen/Geometry>

#include "vdbmap/render/image.h"

/// Anti-aliased shapes and letters on a picture; coordinates in pixels from its upper left corner. What lies outside of
/// the picture is cut off, what is not finite is left out.
namespace vdbmap {

struct Ink {
  Rgb8 color;
  double opacity = 1;  ///< 0..1
};

/// A line through all points with round joints and ends; `width` in pixels.
void draw_polyline(Image& image, std::span<const Eigen::Vector2d> points, double width, const Ink& ink);

void draw_line(Image& image, const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width, const Ink& ink);

void draw_disc(Image& image, const Eigen::Vector2d& center, double radius, const Ink& ink);

/// A ring of `width` whose middle lies at `radius`.
void draw_ring(Image& image, const Eigen::Vector2d& center, double radius, double width, const Ink& ink);

void fill_box(Image& image, const Eigen::AlignedBox2d& box, const Ink& ink);

/// The outline of a box, `width` around its edge.
void draw_box(Image& image, const Eigen::AlignedBox2d& box, double width, const Ink& ink);

/// A convex polygon, its corners in either direction.
void fill_polygon(Image& image, std::span<const Eigen::Vector2d> corners, const Ink& ink);

/// Copies the pixels that lie wholly in the box from a picture of the same size: what was drawn there is clipped to it.
void copy_box(Image& target, const Image& source, const Eigen::AlignedBox2d& box);

}  // namespace vdbmap
