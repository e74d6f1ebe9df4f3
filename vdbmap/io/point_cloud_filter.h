// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "vdbmap/io/point_reader.h"

namespace vdbmap {

/// Removes the points with a NaN or infinite coordinate, together with their attributes; returns their places.
std::vector<std::size_t> drop_non_finite(PointCloud& cloud);

/// The last step of every reader: drops and counts the points that are not finite. Throws IoError where none is left.
ReadResult finish_reading(const std::filesystem::path& path, PointCloud cloud);

}  // namespace vdbmap
