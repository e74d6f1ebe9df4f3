// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vdbmap/io/file/scalar_type.h"
#include "vdbmap/io/points/point_reader.h"

namespace vdbmap {

/// Reads KITTI's Velodyne format, float32 x, y, z, intensity a point, little endian, no header; and what other programs
/// write under the same name: other numbers of columns, doubles. `columns` are their names, with "-" for one that is
/// passed over, and `type` that of all numbers; what is not given is found by guess_bin_layout(). Throws IoError where
/// that is impossible, and std::invalid_argument as check_columns().
ReadResult read_kitti_bin(const std::filesystem::path& path, const std::vector<std::string>& columns = {},
                          std::optional<ScalarType> type = std::nullopt);

/// Writes atomically what the format holds: positions rounded to 32 bits, and intensities, 0 where the cloud has none.
/// Throws IoError (system), and std::invalid_argument as check_writable_cloud().
void write_kitti_bin(const std::filesystem::path& path, const PointCloud& cloud);

}  // namespace vdbmap
