// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "tools/simulator/route.h"
#include "tools/simulator/world.h"

namespace vdbmap::simulator {

/// Where two streets of a quarter meet: a rectangle about the point, along the streets of both.
struct Crossing {
  std::size_t row_street, column_street;  ///< of the layouts
  double row_station, column_station;     ///< [m] of the point on each
  double half_row, half_column;           ///< [m] from the point to the rectangle's ends, along each
};

/// The ground between streets: a rectangle by stations of the first row and the first column.
struct Block {
  double row_from, row_to, column_from, column_to;  ///< [m]
};

/// Streets in rows and columns that cross at right angles on hilly ground, all in one coordinate system.
struct Quarter {
  std::vector<StreetLayout> layouts;  ///< rows, then columns
  std::vector<Crossing> crossings;
  std::vector<Block> blocks;
  std::vector<Leg> tour;  ///< through every street, all of it, with loops
};

/// Plans `options.quarter_columns` by `options.quarter_rows` blocks of 75 to 100 m.
Quarter make_quarter(const StreetOptions& options);

/// Adds the ground of crossings and blocks, and signs at corners.
void add_crossings(World& world, Mesh& mesh, const Quarter& quarter);

}  // namespace vdbmap::simulator
