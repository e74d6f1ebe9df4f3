// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>

#include <Eigen/Geometry>

#include "vdbmap/render/image.h"

namespace vdbmap::test {

/// A picture as another program sees it: read by libpng. Throws std::runtime_error.
Image read_picture(const std::filesystem::path& path);

/// How many pixels of the box (all: of the picture) have just that colour.
std::size_t count_pixels(const Image& image, Rgb8 color);
std::size_t count_pixels(const Image& image, Rgb8 color, const Eigen::AlignedBox2i& box);

}  // namespace vdbmap::test
