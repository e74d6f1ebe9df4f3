// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "tools/simulator/mesh.h"
#include "tools/simulator/parking.h"
#include "tools/simulator/quarter.h"
#include "tools/simulator/street_layout.h"
#include "tools/simulator/things/placing.h"
#include "tools/simulator/vegetation.h"
#include "tools/simulator/world.h"

namespace vdbmap::simulator {

/// A street, or the streets of a quarter, with all epochs.
struct Street {
  StreetOptions options;
  std::vector<StreetLayout> layouts;  ///< of one origin
  std::vector<Crossing> crossings;    ///< of a quarter
  std::vector<Leg> tour;              ///< through a quarter
  World world;
  std::vector<Tree> trees;
  Parking parking;
  std::vector<PlacedThing> things;
  Mesh lasting;                ///< what is the same in every epoch
  std::vector<Mesh> changing;  ///< what is not, by epoch: vehicles, people, bicycles, bins, crowns

  /// All that stands in the street in an epoch.
  Mesh mesh(int epoch) const;

  /// Of the scene [m, EPSG:25832 and height].
  const Eigen::Vector3d& origin() const { return layouts.front().axis.origin; }

  /// Up the street, or the tour. The street must outlive it.
  Route route() const { return tour.empty() ? Route(layouts.front()) : Route(layouts, tour); }

  /// The vehicles that stand there in an epoch, in the order of their spaces, then those in none.
  std::vector<const ParkedVehicle*> vehicles(int epoch) const;
};

/// Plans and draws a street. Throws std::invalid_argument for bad options.
Street make_street(const StreetOptions& options);

}  // namespace vdbmap::simulator
