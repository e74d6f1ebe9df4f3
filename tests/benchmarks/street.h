// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "vdbmap/core/point_cloud.h"

namespace vdbmap::benchmarks {

/// A made-up street as a mobile mapper sees it, with colours, in coordinates as large as UTM's: road, kerbs and
/// pavements, facades with windows, parked cars, poles and trees; 500 points a square metre of surface with 5 mm of
/// noise, about four points in an occupied voxel of 10 cm. Points come profile by profile along the street. The same
/// points every time.
PointCloud make_street(std::size_t num_points);

}  // namespace vdbmap::benchmarks
