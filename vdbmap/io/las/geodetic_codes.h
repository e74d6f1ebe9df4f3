// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace vdbmap {

/// Whether an EPSG code stands for degrees or for coordinates from the centre of the earth, instead of a projection.
bool is_geodetic_epsg(int code);

}  // namespace vdbmap
