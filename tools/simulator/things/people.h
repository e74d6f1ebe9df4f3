// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/simulator/things/site.h"

namespace vdbmap::simulator {

// Who is in the street; each looks along x. The same shapes stand still and move.

void draw_person(const Site& site);
/// Two to five who talk.
void draw_group(const Site& site);
void draw_cyclist(const Site& site);
void draw_motorcyclist(const Site& site);
void draw_wheelchair(const Site& site);
void draw_pram(const Site& site);
/// With its owner.
void draw_dog(const Site& site);

}  // namespace vdbmap::simulator
