// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "vdbmap/io/point_reader.h"

namespace vdbmap {

/// Reads the vertices of a PLY file: ascii, binary little or big endian, numbers of any type. Other elements and
/// properties are passed over, lists too. Throws IoError.
ReadResult read_ply(const std::filesystem::path& path);

enum class PlyEncoding { kAscii, kBinaryLittleEndian };

/// Writes atomically and without loss: positions in double; colours in 8 bits where that suffices, else in 16. Throws
/// IoError.
void write_ply(const std::filesystem::path& path, const PointCloud& cloud,
               PlyEncoding encoding = PlyEncoding::kBinaryLittleEndian);

}  // namespace vdbmap
