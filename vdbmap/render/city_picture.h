// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "vdbmap/render/render.h"
#include "vdbmap/store/city_folder.h"

namespace vdbmap {

/// Draws a city. One of at most `max_voxels` of its finest level is drawn as its map in one piece is; of a larger one
/// so many are drawn, those of the tiles nearest to the camera, as far as they are larger than a pixel, and of the rest
/// the next level. Memory is that of what is drawn, unless a level is asked for, or a diff is drawn. Throws as render()
/// and load_window().
RenderResult render_city(City& city, const RenderOptions& options = {}, const RenderOverlays& overlays = {},
                         std::uint64_t max_voxels = 10'000'000);

}  // namespace vdbmap
