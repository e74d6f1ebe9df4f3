// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/simulator/things/site.h"

namespace vdbmap::simulator {

// Plants without a crown of their own. Each fills its site.

void draw_clipped_hedge(const Site& site);
void draw_wild_bushes(const Site& site);
/// As long, wide and high as a car, clipped round.
void draw_car_sized_shrub(const Site& site);
/// A raised bed with a kerb of stone or wood.
void draw_bed(const Site& site);
void draw_planting(const Site& site);
void draw_low_hedge(const Site& site);
/// On a wall in the plane y = 0 of the site.
void draw_ivy(const Site& site);
/// A bare or planted square of soil with a low guard.
void draw_tree_pit(const Site& site);
/// A trunk thicker than a man with the stumps of its branches, or a felled one's stump.
void draw_thick_trunk(const Site& site);
void draw_conifer(const Site& site);
void draw_tall_grass(const Site& site);

}  // namespace vdbmap::simulator
