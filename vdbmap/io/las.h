// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

#include "vdbmap/core/point_cloud.h"
#include "vdbmap/io/point_reader.h"

namespace vdbmap {

/// Reads LAS 1.0 to 1.4, point formats 0 to 10, without waveforms; and LAZ, formats 0 to 3 and 6 to 8, on all threads
/// allowed, whatever the file is called. Coordinates keep the file's unit, which the result names, as it does the EPSG
/// code, from GeoTIFF keys or WKT. Labels are classifications, times GPS times as the file has them. Intensities,
/// labels and colours that are 0 in every point count as unknown; colours of which none exceeds 255 are taken for
/// 8-bit. Withheld points are left out. Of a damaged file the points that are whole are read, of LAZ the chunks that
/// are, and the findings say what is wrong. Throws IoError, also for coordinates that are degrees or geocentric.
ReadResult read_las(const std::filesystem::path& path);

struct LasWriteOptions {
  std::optional<int> epsg = std::nullopt;  ///< of the projected system, 1024..32766
  double resolution = 0.0001;              ///< [unit of the points] coordinates are right to half of it

  /// Throws std::invalid_argument.
  void check() const;
};

/// Writes LAS 1.2 in point format 0, 1, 2 or 3, whatever the attributes need; rings have no place in it. Intensities up
/// to 1 are stretched to 0..65535, larger ones rounded and clamped to it. Throws IoError (system), and
/// std::invalid_argument as check_writable_cloud(), for labels above 31, and where the points are so far apart that
/// 32 bits of the resolution cannot span them.
void write_las(const std::filesystem::path& path, const PointCloud& cloud, const LasWriteOptions& options = {});

}  // namespace vdbmap
