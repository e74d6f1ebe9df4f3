// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "vdbmap/io/points/point_reader.h"

namespace vdbmap {

/// What the coordinates of a file are, as far as it says.
enum class CoordinateKind {
  kUnknown,
  kProjected,
  kGeographic,  ///< degrees of longitude and latitude
  kGeocentric   ///< metres from the centre of the earth, z along its axis
};

/// A map needs metres and a z that points up. Throws IoError with advice for coordinates that the file says are of
/// another kind. Where most of them are not of the size that the kind has, the file is mistaken: the points are
/// taken, without its EPSG code, and a finding says so.
void check_coordinates(const std::filesystem::path& path, ReadResult& read, CoordinateKind kind);

}  // namespace vdbmap
