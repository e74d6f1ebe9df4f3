// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "vdbmap/render/image.h"

namespace vdbmap {

/// Linear RGB, 0..1.
using LinearColor = Eigen::Vector3f;

LinearColor linear_of(Rgb8 color);

/// The pixel of a colour; what is above 1 is clipped.
Rgb8 pixel_of(const LinearColor& color);

/// From blue over green and yellow to red; `share` is clamped to 0..1.
Rgb8 scale_color(double share);

/// Colours for things without an order, which repeat after some ten.
Rgb8 category_color(std::size_t number);

}  // namespace vdbmap
