// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "tools/simulator/material.h"
#include "tools/simulator/things/site.h"

namespace vdbmap::simulator {

/// Where on a side of the street a kind of thing stands.
enum class Zone {
  kAtKerb,     ///< on the pavement, along the kerb; where cars stand there, behind them
  kAtGardens,  ///< on the pavement, along the gardens
  kInGarden,   ///< between pavement and houses
  kAtWall,     ///< before the wall of a house
  kOnSpace,    ///< on a parking space that no vehicle takes
};

/// How long it stands there.
enum class Stay { kYears, kDay };

/// In which season it is there, and whether it looks different in winter: then it is drawn anew for each epoch.
enum class Season { kAny, kWinter, kSheds };

/// A kind of thing: a row of the table.
struct ThingKind {
  const char* name;
  SurfaceClass label;  ///< of most of it
  Zone zone;
  Stay stay;
  double per_100m;  ///< mean number on 100 m of a side
  double length;    ///< [m] along the street that it takes
  double width;     ///< [m] across
  void (*draw)(const Site& site);
  Season season = Season::kAny;
};

/// All kinds. A new one: a function that draws it, and a row.
std::span<const ThingKind> thing_kinds();

}  // namespace vdbmap::simulator
