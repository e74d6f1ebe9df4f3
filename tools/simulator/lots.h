// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "tools/simulator/random.h"
#include "tools/simulator/street_side.h"

namespace vdbmap::simulator {

/// Divides a side into lots: rows of houses of one type, driveways between them, and a side street where a street of
/// `street_length` [m] is long enough. Needs the side's house types. On a street that is not ideal parks, car parks,
/// halls and open stretches stand among them, and the side street may be given, so that two sides have one crossing.
std::vector<Lot> make_lots(const SideLayout& side, const Interval& stretch, double street_length, Random& random);
struct LotPlan {
  std::optional<double> side_street;  ///< station [m] where it begins
  double special_share = 0.25;        ///< of the rows that something else than houses follows
};
std::vector<Lot> make_rough_lots(const SideLayout& side, const Interval& stretch, const LotPlan& plan, Random& random);

}  // namespace vdbmap::simulator
