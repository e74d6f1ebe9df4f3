// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "tools/simulator/random.h"

namespace vdbmap::simulator {

/// What kind of houses a side has.
enum class Housing { kTerraced, kBlock, kDetached };

enum class RoofKind { kAlong, kAcross, kFlat };  ///< ridge along the street, square to it, none

/// What houses built from one drawing share. Lengths [m].
struct HouseType {
  double width;
  double depth;
  int num_storeys;
  double storey_height;
  double plinth;  ///< height of the ground floor above the street
  RoofKind roof;
  double roof_slope;  ///< rise by run
  int num_axes;       ///< windows side by side
  int door_axis;      ///< which of them is the door on the ground floor
  double window_width;
  double window_height;
  double sill;        ///< of a window above its floor
  double recess;      ///< how far windows stand back
  int bay_axis;       ///< which axis has a bay window, or -1
  int balcony_axis;   ///< which axis has balconies, or -1
  bool has_brick;     ///< else plaster
  bool has_dormers;   ///< on roofs along the street
  double stand_back;  ///< of the whole house behind the line of the others
};

/// A few types for a side: streets are built in rows of the same house.
std::vector<HouseType> make_house_types(Housing housing, std::size_t count, Random& random);

}  // namespace vdbmap::simulator
