// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/spaces/find_spaces.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "parking/ground_plan.h"
#include "parking/spaces/free_kerb.h"
#include "parking/spaces/kerb_rows.h"

namespace vdbmap::parking {
namespace {

constexpr double kSameSpace = 0.5;    // of the smaller area: a vehicle in a space
constexpr double kBesideSpace = 0.2;  // more: no space of its own
constexpr double kMostOverlap = 0.1;  // of two spaces, or they are said to overlap
constexpr double kGroundReach = 3.5;  // [m] from the middle of a vehicle

ParkingSpace space_of_vehicle(const Vehicle& vehicle, const GroundPlan& ground) {
  const auto corners = vehicle.box.corners();
  ParkingSpace space = space_of_outline({corners.begin(), corners.end()});
  space.ground = ground.height_near(vehicle.box.center.head<2>(), kGroundReach);
  if (!space.ground) space.ground = vehicle.box.center.z() - vehicle.box.height / 2;
  return space;
}

struct Place {
  std::size_t space;
  double share;
};

// The space with which a box shares most.
std::optional<Place> best_place(const UprightBox& box, std::span<const ParkingSpace> spaces) {
  std::optional<Place> best;
  for (std::size_t i = 0; i < spaces.size(); ++i) {
    const double share = shared_area(box, box_of(spaces[i]));
    if (share > 0 && (!best || share > best->share)) best = Place{i, share};
  }
  return best;
}

// A candidate on which a vehicle stands is a space of the vehicle's size.
void take_vehicle(ParkingSpace& known, const ParkingSpace& found) {
  if (!known.is_candidate) return;
  ParkingSpace space = found;
  space.id = known.id;
  space.history = std::move(known.history);
  known = std::move(space);
}

// Numbers that no space has.
class FreeIds {
 public:
  explicit FreeIds(std::span<const ParkingSpace> spaces) {
    for (const ParkingSpace& space : spaces) taken_.insert(space.id);
  }
  std::string next() {
    while (taken_.contains(std::to_string(++last_))) {
    }
    return std::to_string(last_);
  }

 private:
  std::set<std::string> taken_;
  std::size_t last_ = 0;
};

void describe(std::span<ParkingSpace> spaces, std::span<const KerbRow> rows) {
  for (const KerbRow& row : rows) {
    for (const std::size_t i : row.spaces) {
      if (spaces[i].kerb_side.empty()) spaces[i].kerb_side = row.side;
      if (spaces[i].angle == ParkingAngle::kUnknown) spaces[i].angle = row.angle;
    }
  }
}

// Candidates that are known and still free go on; new ones must not lie on them.
void add_candidates(std::vector<ParkingSpace>& spaces, std::vector<ParkingSpace> known,
                    std::vector<ParkingSpace> found) {
  for (std::vector<ParkingSpace>* candidates : {&known, &found}) {
    for (ParkingSpace& candidate : *candidates) {
      const std::optional<Place> place = best_place(box_of(candidate), spaces);
      if (!place || place->share <= kMostOverlap) spaces.push_back(std::move(candidate));
    }
  }
}

// The rows of spaces, without new ones in the lane.
std::vector<KerbRow> drop_from_lane(std::vector<ParkingSpace>& spaces, const GroundPlan& ground,
                                    std::vector<std::string>& doubts) {
  std::vector<KerbRow> rows = find_kerb_rows(spaces, ground);
  std::vector<bool> is_dropped(spaces.size(), false);
  for (const KerbRow& row : rows) {
    if (!is_in_lane(row, rows, spaces)) continue;
    for (const std::size_t i : row.spaces) is_dropped[i] = spaces[i].id.empty();
  }
  if (std::ranges::count(is_dropped, true) == 0) return rows;
  std::vector<ParkingSpace> kept;
  for (std::size_t i = 0; i < spaces.size(); ++i) {
    if (is_dropped[i]) {
      doubts.emplace_back("stands in the lane");
    } else {
      kept.push_back(std::move(spaces[i]));
    }
  }
  spaces = std::move(kept);
  return find_kerb_rows(spaces, ground);
}

}  // namespace

FoundSpaces find_spaces(const VoxelLevel& level, const FindSpacesOptions& options) {
  const std::vector<Vehicle> vehicles = find_vehicles(level);
  const GroundPlan ground(level);
  FoundSpaces result;
  result.num_vehicles = vehicles.size();
  std::vector<ParkingSpace> spaces = options.known;
  std::vector<bool> is_taken(spaces.size(), false);
  const std::size_t num_known = spaces.size();
  for (const Vehicle& vehicle : vehicles) {
    if (!vehicle.doubt.empty()) {
      result.doubts.push_back(vehicle.doubt);
      continue;
    }
    const ParkingSpace found = space_of_vehicle(vehicle, ground);
    const std::optional<Place> place = best_place(vehicle.box, spaces);
    if (place && place->share >= kSameSpace) {
      take_vehicle(spaces[place->space], found);
      is_taken[place->space] = true;
    } else if (!place || place->share < kBesideSpace) {
      spaces.push_back(found);
      is_taken.push_back(true);
    }
  }

  for (std::size_t i = 0; i < spaces.size(); ++i) {
    if (is_taken[i]) spaces[i].history.push_back({options.date, SpaceState::kOccupied});
  }
  std::vector<ParkingSpace> known_candidates, all;
  for (ParkingSpace& space : spaces) (space.is_candidate ? known_candidates : all).push_back(std::move(space));
  const std::vector<KerbRow> rows = drop_from_lane(all, ground, result.doubts);
  describe(all, rows);
  FreeIds ids(options.known);
  std::vector<ParkingSpace> in_order;
  for (ParkingSpace& space : all) {
    if (!space.id.empty()) in_order.push_back(space);
  }
  result.num_seen_again = static_cast<std::size_t>(
      std::count(is_taken.begin(), is_taken.begin() + static_cast<std::ptrdiff_t>(num_known), true));
  std::vector<ParkingSpace> candidates = find_free_kerb(all, rows, ground);
  for (const KerbRow& row : rows) {
    for (const std::size_t i : row.spaces) {
      if (!all[i].id.empty()) continue;
      in_order.push_back(all[i]);
      in_order.back().id = ids.next();
      ++result.num_new;
    }
  }
  add_candidates(in_order, std::move(known_candidates), std::move(candidates));
  for (ParkingSpace& space : in_order) {
    if (space.id.empty()) space.id = ids.next();
  }
  result.spaces = std::move(in_order);
  return result;
}

std::vector<SpaceOverlap> find_overlaps(std::span<const ParkingSpace> spaces) {
  std::vector<UprightBox> boxes;
  for (const ParkingSpace& space : spaces) boxes.push_back(box_of(space));
  std::vector<SpaceOverlap> overlaps;
  for (std::size_t a = 0; a < spaces.size(); ++a) {
    for (std::size_t b = a + 1; b < spaces.size(); ++b) {
      const double share = shared_area(boxes[a], boxes[b]);
      if (share > kMostOverlap) overlaps.push_back({a, b, share});
    }
  }
  return overlaps;
}

}  // namespace vdbmap::parking
