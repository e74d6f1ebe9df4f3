// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>
#include <openvdb/points/PointDataGrid.h>

// The grids of our files, and of others that are checked. OpenVDB's library holds their trees and what a grid does to a
// whole tree, compiled: said here, since its headers do not, and each file that makes such a grid would compile all of
// it again, for ten seconds. Clang counts on the library for small functions too, which it does not show.
#ifndef __clang__

#define VDBMAP_STANDARD_GRID(Type)                                         \
  extern template class openvdb::tree::Tree<Type::TreeType::RootNodeType>; \
  extern template void openvdb::Grid<Type::TreeType>::pruneGrid(float);    \
  extern template void openvdb::Grid<Type::TreeType>::clip(const openvdb::CoordBBox&)

VDBMAP_STANDARD_GRID(openvdb::BoolGrid);
VDBMAP_STANDARD_GRID(openvdb::DoubleGrid);
VDBMAP_STANDARD_GRID(openvdb::FloatGrid);
VDBMAP_STANDARD_GRID(openvdb::Int32Grid);
VDBMAP_STANDARD_GRID(openvdb::Vec3DGrid);
VDBMAP_STANDARD_GRID(openvdb::Vec3SGrid);
VDBMAP_STANDARD_GRID(openvdb::points::PointDataGrid);

#undef VDBMAP_STANDARD_GRID

#endif
