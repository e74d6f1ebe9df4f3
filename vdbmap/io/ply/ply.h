// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "vdbmap/io/points/point_reader.h"

namespace vdbmap {

/// Reads the vertices of a PLY file: ascii, binary little or big endian, numbers of any type. Other elements and
/// properties are passed over, lists too. In text, points may share lines or span them. Of a file that ends too early
/// the whole points are kept, of a text all lines that hold points; a value that is no number is missing (NaN, and 0 of
/// colours, rings and labels). The findings count what is left out. Throws IoError where no point is whole, or more
/// lines of a text are broken than whole.
ReadResult read_ply(const std::filesystem::path& path);

enum class PlyEncoding { kAscii, kBinaryLittleEndian };

/// Writes atomically and without loss: positions in double; colours in 8 bits where that suffices, else in 16. Throws
/// IoError.
void write_ply(const std::filesystem::path& path, const PointCloud& cloud,
               PlyEncoding encoding = PlyEncoding::kBinaryLittleEndian);

}  // namespace vdbmap
