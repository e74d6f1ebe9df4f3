// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "tools/simulator/parking.h"
#include "tools/simulator/street_layout.h"
#include "tools/simulator/things/kinds.h"

namespace vdbmap::simulator {

/// A thing's place, planned before anything is drawn.
struct PlacedThing {
  const ThingKind* kind;
  Eigen::Isometry3d scene_from_thing;  ///< as Site has it
  ObjectId object;
  std::uint64_t seed;
  int epoch;                         ///< the one in which it is there, or -1 for every one
  std::optional<std::size_t> space;  ///< that it blocks
};

/// Chooses things for both sides of the street of that index and all epochs, so that those of one zone do not touch;
/// things of a day block parking spaces that no vehicle takes.
std::vector<PlacedThing> place_things(World& world, const StreetLayout& layout, std::size_t street,
                                      const Parking& parking, const StreetOptions& options, std::uint64_t seed);

/// Draws what is the same in every epoch.
void draw_lasting_things(World& world, Mesh& mesh, const std::vector<PlacedThing>& things);

/// Draws what an epoch has of its own, plants that shed their leaves included.
void draw_changing_things(World& world, Mesh& mesh, const std::vector<PlacedThing>& things, int epoch, bool is_winter);

/// Whether an epoch of a street lies in winter: leaves are off, snow may lie.
bool is_winter(const StreetOptions& options, int epoch);

}  // namespace vdbmap::simulator
