// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "vdbmap/core/point_cloud.h"
#include "vdbmap/io/point_reader.h"

namespace vdbmap {

/// Reads text with a point a line: columns parted by blanks, tabs, a comma or a semicolon, '#' and '//' comments, lines
/// ended by LF or CRLF. A first line that names x, y and z says what the columns are, in a comment or not; case does
/// not matter and unknown columns are passed over. Known beside them: r g b or red green blue, intensity, time or
/// timestamp [s], offset_ns, ring or laser_number, label or classification. Without names 3 columns are x y z, 4 x y z
/// intensity, 6 x y z r g b and 7 x y z intensity r g b. Colours are 16-bit where one exceeds 255 or they are named r16
/// g16 b16, else 8-bit. Throws IoError with the line.
ReadResult read_xyz(const std::filesystem::path& path);

/// Writes a comment that names the columns and a point a line, in the fewest digits that read back the same. Colours
/// that 8 bits can express are written so. Throws IoError (system), and std::invalid_argument as
/// check_writable_cloud().
void write_xyz(const std::filesystem::path& path, const PointCloud& cloud);

}  // namespace vdbmap
