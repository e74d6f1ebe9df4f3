// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/simulator/random.h"
#include "tools/simulator/world.h"

namespace vdbmap::simulator {

/// A plant without a trunk that light enters: leaves about the surface of a superellipsoid (Barr 1981), fewer inwards.
struct ShrubShape {
  Eigen::Vector3d size;     ///< [m] along x and y, about the origin; z from the ground
  double exponent = 2.5;    ///< 2: round; 8: clipped to a box
  double leaf_size = 0.07;  ///< [m] of a leaf or a sprig of small ones
  double depth = 0.15;      ///< [m] that leaves stand inwards, on average
  double density = 200;     ///< leaves of 0.1 m a square metre of surface; smaller ones are as many more
  double wave = 0.05;       ///< share by which the surface swings in and out
  double base = 0;          ///< [m] height of its foot
  double leaf_share = 1;    ///< of the leaves that hang: few in winter
  bool is_dense = false;    ///< no light goes through it: where few leaves stand any more, its inside is opaque
};

/// Adds leaves, and the inside of a dense plant, with the brush's material and `twigs` that rise from the foot through
/// them.
void add_shrub(const Brush& leaves, MaterialId twigs, const ShrubShape& shape, Random& random);

/// A clipped hedge, as light enters real ones: x from 0 to the length, y from 0 to the depth, z up.
void add_rough_hedge(const Brush& leaves, MaterialId twigs, const Eigen::Vector3d& size, Random& random);

/// A wild bush of about the radius [m].
void add_rough_bush(const Brush& leaves, MaterialId twigs, double radius, Random& random);

}  // namespace vdbmap::simulator
