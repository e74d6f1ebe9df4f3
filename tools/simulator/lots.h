// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "tools/simulator/random.h"
#include "tools/simulator/street_side.h"

namespace vdbmap::simulator {

/// Divides a side into lots: rows of houses of one type, driveways between them, and a side street where a street of
/// `street_length` [m] is long enough. Needs the side's house types.
std::vector<Lot> make_lots(const SideLayout& side, const Interval& stretch, double street_length, Random& random);

}  // namespace vdbmap::simulator
