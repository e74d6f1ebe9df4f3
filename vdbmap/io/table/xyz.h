// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vdbmap/core/point_cloud.h"
#include "vdbmap/io/points/point_reader.h"

namespace vdbmap {

/// Reads text with a point a line: columns parted by blanks, tabs, commas, semicolons or bars, with decimal points, or
/// with decimal commas where these cannot part columns; '#' and '//' comments; lines ended by LF, CRLF or CR. What is
/// not certain is refused.
///
/// A line before the first point that names x, y and z says what the columns are, in a comment or not: as many names as
/// columns, parted as they are. find_name() knows the names; other columns are passed over, whatever they hold. Without
/// names, the orders of common programs are told apart by the numbers: layout_of_values(). `columns` overrides both,
/// with "-" for a column that is passed over. Times are seconds unless the name states another unit; ColorRange says
/// what scale colours have.
///
/// A count of points may stand on top (Leica's .pts, CloudCompare), and in a .pts file before each block. A row without
/// coordinates or with too few or too many columns is left out; any other value that is no number is missing (NaN, and
/// 0 of colours, rings and labels). Both are counted in the findings. More broken rows than whole ones are an error,
/// with the line. Throws IoError, and std::invalid_argument as check_columns().
ReadResult read_xyz(const std::filesystem::path& path, const std::vector<std::string>& columns = {});

/// Writes a comment that names the columns and a point a line, in the fewest digits that read back the same. Colours
/// that 8 bits can express are written so. Throws IoError (system), and std::invalid_argument as
/// check_writable_cloud().
void write_xyz(const std::filesystem::path& path, const PointCloud& cloud);

}  // namespace vdbmap
