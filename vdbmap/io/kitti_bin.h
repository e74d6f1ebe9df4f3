// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "vdbmap/io/point_reader.h"

namespace vdbmap {

/// Reads KITTI's Velodyne format: float32 x, y, z, intensity a point, little endian, no header. Throws IoError.
ReadResult read_kitti_bin(const std::filesystem::path& path);

/// Writes atomically what the format holds: positions rounded to 32 bits, and intensities, 0 where the cloud has none.
/// Throws IoError (system), and std::invalid_argument as check_writable_cloud().
void write_kitti_bin(const std::filesystem::path& path, const PointCloud& cloud);

}  // namespace vdbmap
