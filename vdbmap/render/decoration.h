// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "vdbmap/render/camera.h"
#include "vdbmap/render/image.h"
#include "vdbmap/render/voxel_colors.h"

/// What makes a picture a map: grid, scale, north and legend.
namespace vdbmap {

/// Size of letters that suits a picture [pixels].
int letter_size(const ImageSize& size);

/// Lines at whole metres with their coordinates, over a view from straight above; `anchor` leads to the original
/// system.
void draw_metre_grid(Image& image, const Camera& camera, const Eigen::Vector3d& anchor);

/// A bar of a round length in the lower left corner; `note` follows its length: "5 m at 20 m distance".
void draw_scale_bar(Image& image, double metres_per_pixel, const std::string& note);

/// An arrow in the upper right corner that points to +y; `heading_deg` is that of the view, to the left of +x.
void draw_north_arrow(Image& image, double heading_deg);

/// A panel in the lower right corner: the scale of the colours, or their names, and the names of what is drawn over
/// them.
void draw_color_legend(Image& image, const ColorLegend& legend,
                       const std::vector<std::pair<std::string, Rgb8>>& overlays);

}  // namespace vdbmap
