// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "vdbmap/render/image.h"

namespace vdbmap {

/// A rectangle of a picture with the axes of a diagram: values grow to the right and upwards.
struct PlotArea {
  Eigen::AlignedBox2d frame;   ///< [pixels]
  Eigen::AlignedBox2d values;  ///< in the units of the axes

  Eigen::Vector2d pixel_of(const Eigen::Vector2d& value) const;
};

/// The area with its values widened about their middle until a unit has as many pixels on both axes.
PlotArea with_equal_scale(PlotArea area);

struct AxisLabels {
  std::string title;  ///< above the frame
  std::string x;      ///< below it, with the unit
  std::string y;      ///< to its left, with the unit
};

/// The smallest of 1, 2, 5 times a power of ten that is not below `least` (above 0).
double round_step(double least);

/// The multiples of `step` in [low, high].
std::vector<double> ticks_between(double low, double high, double step);

/// A number with as many decimals as multiples of `step` need.
std::string tick_text(double value, double step);

/// Draws frame, grid, ticks with numbers and labels. Leaves room for the numbers outside of the frame to the caller:
/// some 70 pixels on the left, 50 below, 30 above.
void draw_axes(Image& image, const PlotArea& area, const AxisLabels& labels);

}  // namespace vdbmap
