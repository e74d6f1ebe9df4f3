// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/simulator/things/site.h"

namespace vdbmap::simulator {

// What front gardens end with, besides plants.

/// A mound along the street, grown with grass.
void draw_bank(const Site& site);
/// One to three boulders.
void draw_boulders(const Site& site);
/// A low wall with a hedge on it.
void draw_walled_hedge(const Site& site);

}  // namespace vdbmap::simulator
