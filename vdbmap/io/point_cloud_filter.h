// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "vdbmap/io/point_reader.h"

namespace vdbmap {

/// Removes the points with a NaN or infinite coordinate, together with their attributes; returns their places.
std::vector<std::size_t> drop_non_finite(PointCloud& cloud);

/// Removes the points at these places of the cloud, which rise, with their attributes, and notes why.
void drop_points(ReadResult& read, std::span<const std::size_t> places, const ReadFinding& finding);

/// The last step of every reader: drops and counts the points that are not finite. Throws IoError where none is left.
ReadResult finish_reading(const std::filesystem::path& path, PointCloud cloud);

}  // namespace vdbmap
