// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "vdbmap/io/points/point_reader.h"

namespace vdbmap {

/// Reads a PCD file: ascii, binary or binary_compressed, numbers of any type. Fields that a PointCloud has no place for
/// are passed over, as is VIEWPOINT. Of a file with fewer points than its header promises, or with broken lines of
/// text, the whole points are kept as read_ply() does. Throws IoError.
ReadResult read_pcd(const std::filesystem::path& path);

enum class PcdEncoding { kAscii, kBinary, kBinaryCompressed };

/// Writes atomically: positions in 32 bits where that keeps them exactly, as PCL's programs want them, else in 64;
/// colours rounded to 8 bits a channel; time as 64-bit seconds. Throws IoError (system), and std::invalid_argument as
/// check_writable_cloud() and for a compressed file above 4 GiB.
void write_pcd(const std::filesystem::path& path, const PointCloud& cloud, PcdEncoding encoding = PcdEncoding::kBinary);

}  // namespace vdbmap
