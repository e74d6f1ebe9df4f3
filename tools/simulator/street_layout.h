// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include <Eigen/Geometry>

#include "tools/simulator/street_axis.h"
#include "tools/simulator/street_options.h"
#include "tools/simulator/street_side.h"

namespace vdbmap::simulator {

/// The ground plan: everything that stays, without the things that stand on it.
struct StreetLayout {
  StreetAxis axis;
  double length;                    ///< [m] cars park at stations 0 to `length`
  double margin;                    ///< [m] that the houses go on before and after
  std::array<SideLayout, 2> sides;  ///< left, right
  bool is_ideal = true;             ///< as StreetOptions has it
  double ground_depth = 70;         ///< [m] from the axis that its ground reaches
  double scenery_depth = 70;        ///< [m] from the axis that what stands on it reaches; not on an ideal street

  double begin() const { return -margin; }
  double end() const { return length + margin; }

  /// The side on which an offset [m, left positive] lies.
  const SideLayout& side_of(double offset) const { return offset >= 0 ? sides[0] : sides[1]; }

  /// Height [m, scene frame] of the ground; at the kerb's offset that of the road.
  double ground_height(double station, double offset) const;

  /// A frame on the ground: x along the street turned by `yaw` [rad], z up.
  Eigen::Isometry3d place(double station, double offset, double yaw = 0) const;

  /// A frame on the ground beside the street: x along it, y away from it; on the right x runs against the stations.
  Eigen::Isometry3d place_on_side(const SideLayout& side, double station, double distance) const;

  /// The frame before a lot, `distance` [m] from the axis: x along its front, from 0 to the lot's length, y away from
  /// the street.
  Eigen::Isometry3d place_lot(const SideLayout& side, const Lot& lot, double distance) const;
};

/// A side as make_layout() plans it: how cars park, what houses stand there, how wide all is; without lots.
SideLayout make_rough_side(double sign, bool may_be_empty, Random& random);

/// The trees between the spaces of a side that has its lots.
void add_islands(SideLayout& side, double street_length, Random& random);

/// Plans a street.
StreetLayout make_layout(const StreetOptions& options);

}  // namespace vdbmap::simulator
