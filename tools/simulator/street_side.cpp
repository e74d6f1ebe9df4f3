// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/street_side.h"

#include <algorithm>
#include <array>

namespace vdbmap::simulator {
namespace {

constexpr double kLoweredKerb = 0.25;    // of its height, at driveways
constexpr double kDrivewayRamp = 0.6;    // [m] along the kerb
constexpr double kSideStreetRamp = 2.0;  // [m]

// 0 within the stretch, 1 from `ramp` outside on.
double rise_outside(const Interval& stretch, double station, double ramp) {
  const double outside = std::max({stretch.begin - station, station - stretch.end, 0.0});
  return std::min(outside / ramp, 1.0);
}

}  // namespace

std::string name_of(ParkingKind kind) {
  constexpr std::array<const char*, 5> kNames = {"none", "parallel", "half on pavement", "on pavement", "angled"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::string name_of(LotKind kind) {
  constexpr std::array<const char*, 9> kNames = {"house",    "gap",  "driveway", "side street", "park",
                                                 "car park", "hall", "open",     "crossing"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::vector<Interval> SideLayout::stretches(LotKind kind) const {
  std::vector<Interval> found;
  for (const Lot& lot : lots) {
    if (lot.kind == kind) found.push_back(lot.along);
  }
  return found;
}

double SideLayout::kerb_share(double station) const {
  double share = 1;
  for (const Lot& lot : lots) {
    if (lot.kind == LotKind::kDriveway) {
      share = std::min(share, kLoweredKerb + (1 - kLoweredKerb) * rise_outside(lot.along, station, kDrivewayRamp));
    } else if (lot.kind == LotKind::kSideStreet || lot.kind == LotKind::kCrossing) {
      share = std::min(share, rise_outside(lot.along, station, kSideStreetRamp));
    }
  }
  return share;
}

bool SideLayout::is_plain(const Interval& stretch, double margin) const {
  return std::ranges::none_of(lots, [&](const Lot& lot) {
    const bool is_open =
        lot.kind == LotKind::kDriveway || lot.kind == LotKind::kSideStreet || lot.kind == LotKind::kCrossing;
    return is_open && lot.along.meets(stretch, margin);
  });
}

}  // namespace vdbmap::simulator
