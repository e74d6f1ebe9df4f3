// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/simulator/things/site.h"

namespace vdbmap::simulator {

// What people put into a street for a day or for years. Each fills its site.

void draw_skip(const Site& site);
/// Before a wall in the plane y = 0.5 m of the site.
void draw_scaffolding(const Site& site);
void draw_cafe(const Site& site);
void draw_market_stall(const Site& site);
void draw_pallets(const Site& site);
void draw_snow_heap(const Site& site);
void draw_construction_fence(const Site& site);
/// A row of bins on collection day.
void draw_bin_row(const Site& site);
void draw_wide_sign(const Site& site);
void draw_cabinet(const Site& site);
void draw_bench(const Site& site);
void draw_bus_shelter(const Site& site);
void draw_parked_bicycles(const Site& site);

}  // namespace vdbmap::simulator
