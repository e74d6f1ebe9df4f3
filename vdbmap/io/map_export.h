// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "vdbmap/core/point_cloud.h"
#include "vdbmap/core/voxel_map.h"
#include "vdbmap/io/points/point_format.h"

namespace vdbmap {

/// One point a voxel, in the order of the records: the mean in the original system, colour, intensity and label where
/// the map has them; a label that does not fit a cloud's 16 bits is none.
PointCloud points_of_level(const VoxelMap& map, const VoxelLevel& level);

/// The format of a point file to be written: PLY, LAS or XYZ. Throws std::invalid_argument for any other extension.
PointFormat export_format(const std::filesystem::path& path);

/// Writes a cloud in the format of the extension; LAS with the EPSG code, if any. Throws IoError, and
/// std::invalid_argument as export_format() and the writers do.
void write_points(const std::filesystem::path& path, const PointCloud& cloud,
                  const std::optional<int>& epsg = std::nullopt);

/// Writes points_of_level() in the format of the extension, PLY and XYZ with the coordinates of
/// mean_in_original_system(): in the digits that they have, a map built of them has the same means. LAS with the EPSG
/// code and with classes of ASPRS's numbers (asprs_label()), as far as the map knows whose its own are; one above the
/// 31 that LAS 1.2 has room for becomes 1, unclassified. Throws IoError, and std::invalid_argument as export_format()
/// and write_las() do.
void export_points(const std::filesystem::path& path, const VoxelMap& map, const VoxelLevel& level);

/// The same of the voxels whose mean lies in the closed box [m, original system]; returns how many these are. Throws
/// as export_points() does, and std::invalid_argument where there is none.
std::size_t export_points_in_box(const std::filesystem::path& path, const VoxelMap& map, const VoxelLevel& level,
                                 const Extent& box);

}  // namespace vdbmap
