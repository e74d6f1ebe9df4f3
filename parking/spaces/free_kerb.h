// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "parking/ground_plan.h"
#include "parking/spaces/kerb_rows.h"
#include "parking/spaces/parking_space.h"

namespace vdbmap::parking {

/// Candidates for further spaces: free kerb between two spaces of a row, at least 5.2 m long where cars stand parallel
/// to it and 2.4 m a car where they do not, on which ground is seen and nothing stands. Whether one may park there, a
/// driveway for example, the map does not know.
std::vector<ParkingSpace> find_free_kerb(std::span<const ParkingSpace> spaces, std::span<const KerbRow> rows,
                                         const GroundPlan& ground);

}  // namespace vdbmap::parking
