// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "tools/simulator/random.h"
#include "tools/simulator/world.h"

namespace vdbmap::simulator {

/// A broad-leaved tree. Lengths [m].
struct Tree {
  Eigen::Isometry3d scene_from_foot;
  double trunk_height;  ///< up to the first branches
  double trunk_radius;
  double crown_radius;
  double crown_height;  ///< from the first branches to the top
  MaterialId leaves = 0;
  ObjectId object = 0;
  std::uint64_t seed = 0;
};

/// A tree whose crown has about the radius [m].
Tree make_tree(const Eigen::Isometry3d& scene_from_foot, double crown_radius, Random& random);

/// A young tree or large shrub whose branches begin at the height of a knee.
Tree make_low_tree(const Eigen::Isometry3d& scene_from_foot, double crown_radius, Random& random);

/// Adds trunk and branches.
void add_wood(Mesh& mesh, const Tree& tree, const StandardMaterials& materials);

/// Makes a tree one of those that planners do not draw: it leans, its trunk is thick or its crown ragged.
void roughen(Tree& tree, Random& random);

/// Adds the leaves of an epoch, or a share of them: a crown loses and gains some between epochs.
void add_crown(Mesh& mesh, const Tree& tree, int epoch, double leaf_share = 1);

/// Adds a hedge: x from 0 to `length`, y from 0 to `depth`, z from 0 to `height` [m].
void add_hedge(const Brush& brush, const Eigen::Vector3d& size, Random& random);

/// Adds a round bush on the ground.
void add_bush(const Brush& brush, double radius, Random& random);

}  // namespace vdbmap::simulator
