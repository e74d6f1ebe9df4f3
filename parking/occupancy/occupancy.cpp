// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/occupancy/occupancy.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "parking/spaces/iso_date.h"

namespace vdbmap::parking {
namespace {

constexpr double kHalfSure = 10;  // points of a vehicle or a thing
constexpr double kMillisecondsADay = 24.0 * 3600 * 1000;

double share_of(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

// Rays through windows and over bonnets pass most columns of a car, but none below.
bool is_seen_through(const SpaceEvidence& evidence, const OccupancyRule& rule) {
  return share_of(evidence.num_passed, evidence.num_columns) >= rule.passed_share &&
         share_of(evidence.num_passed_low, evidence.num_columns) >= rule.low_share;
}

bool has_other_things(const SpaceEvidence& evidence, const OccupancyRule& rule) {
  const double most = evidence.rays_through < rule.many_rays && evidence.rays_through > 0 ? 0 : rule.other_share;
  return share_of(evidence.num_with_other, evidence.num_columns) > most;
}

// Whether a vehicle was there for a moment only: rays passed nearly everywhere, and much more often than it was met.
bool has_passed_by(const SpaceEvidence& evidence, const OccupancyRule& rule) {
  constexpr double kNearlyAll = 0.9;
  const auto points = static_cast<double>(evidence.vehicle_points - evidence.neighbor_points);
  return share_of(evidence.num_passed_low, evidence.num_columns) >= kNearlyAll &&
         points < rule.standing_share * static_cast<double>(evidence.rays_through);
}

bool is_vehicle_there(const SpaceEvidence& evidence, const OccupancyRule& rule) {
  return evidence.vehicle_points - evidence.neighbor_points >= rule.vehicle_points &&
         evidence.num_with_vehicle >= rule.vehicle_columns && !has_passed_by(evidence, rule);
}

bool is_thing_there(const SpaceEvidence& evidence, const OccupancyRule& rule) {
  return evidence.thing_points >= rule.thing_points && evidence.num_with_thing >= rule.thing_columns &&
         evidence.thing_height >= rule.thing_height &&
         static_cast<double>(evidence.thing_points) >= rule.thing_share * static_cast<double>(evidence.rays_through);
}

double sure_of(std::uint64_t points) { return static_cast<double>(points) / (static_cast<double>(points) + kHalfSure); }

std::string reason_unknown(const SpaceEvidence& evidence, const OccupancyRule& rule) {
  std::ostringstream text;
  if (!evidence.is_in_map) return "the map has no ground there";
  if (evidence.vehicle_points - evidence.neighbor_points > rule.stray_points) {
    text << (has_passed_by(evidence, rule) ? "a vehicle that passed by, or little of one: "
                                           : "too little of a vehicle: ")
         << evidence.vehicle_points - evidence.neighbor_points << " points in " << evidence.num_with_vehicle
         << " columns";
  } else if (evidence.num_passed == 0) {
    return "not seen";
  } else if (!is_seen_through(evidence, rule)) {
    text << "rays passed " << evidence.num_passed << " of " << evidence.num_columns << " columns, "
         << evidence.num_passed_low << " of them below " << SpaceColumns::kSill << " m";
  } else {
    return "something stands there that is not known to be a vehicle";
  }
  return text.str();
}

std::optional<double> days_between(const std::string& from, const std::string& to) {
  const auto begin = milliseconds_of(from), end = milliseconds_of(to);
  if (!begin || !end) return std::nullopt;
  return static_cast<double>(*end - *begin) / kMillisecondsADay;
}

}  // namespace

void OccupancyRule::check() const {
  const auto check_share = [](const char* name, double share) {
    if (share >= 0 && share <= 1) return;
    throw std::invalid_argument(std::string(name) + " " + std::to_string(share) + ", expected 0 to 1");
  };
  check_share("share of passed columns", passed_share);
  check_share("share of columns passed below windows", low_share);
  check_share("share of columns with other things", other_share);
  check_share("share of points of a vehicle that stands", standing_share);
  check_share("share of points of a thing that stands", thing_share);
}

std::string_view text_of(Occupant occupant) { return occupant == Occupant::kVehicle ? "vehicle" : "thing"; }

SpaceOccupancy judge(const SpaceEvidence& evidence, const OccupancyRule& rule) {
  SpaceOccupancy result;
  result.evidence = evidence;
  if (!evidence.is_in_map) {
    result.reason = reason_unknown(evidence, rule);
    return result;
  }
  if (rule.as_paper) {
    result.state = evidence.vehicle_points > 0 ? SpaceState::kOccupied : SpaceState::kVacant;
    if (evidence.vehicle_points > 0) result.occupant = Occupant::kVehicle;
    result.confidence = 1;
    return result;
  }
  const std::uint64_t own_points = evidence.vehicle_points - evidence.neighbor_points;
  const double passed = share_of(evidence.num_passed, evidence.num_columns);
  if (is_vehicle_there(evidence, rule)) {
    result.state = SpaceState::kOccupied;
    result.occupant = Occupant::kVehicle;
    result.confidence = sure_of(own_points);
  } else if (is_thing_there(evidence, rule)) {
    result.state = SpaceState::kOccupied;
    result.occupant = Occupant::kThing;
    result.confidence = sure_of(evidence.thing_points);
  } else if (is_seen_through(evidence, rule) && !has_other_things(evidence, rule) && own_points <= rule.stray_points) {
    result.state = SpaceState::kVacant;
    result.confidence = std::max(0.0, passed - share_of(evidence.num_with_other, evidence.num_columns));
  } else {
    result.reason = reason_unknown(evidence, rule);
  }
  return result;
}

double StreetOccupancy::low() const { return share_of(num_occupied, num_spaces()); }

double StreetOccupancy::high() const { return share_of(num_occupied + num_unknown, num_spaces()); }

std::optional<double> StreetOccupancy::known() const {
  const std::size_t num_known = num_occupied + num_vacant;
  return num_known == 0 ? std::nullopt : std::optional(share_of(num_occupied, num_known));
}

StreetOccupancy street_occupancy(std::span<const ParkingSpace> spaces, std::span<const SpaceOccupancy> states) {
  StreetOccupancy street;
  for (std::size_t i = 0; i < spaces.size(); ++i) {
    if (spaces[i].is_candidate) continue;
    switch (states[i].state) {
      case SpaceState::kOccupied:
        ++street.num_occupied;
        break;
      case SpaceState::kVacant:
        ++street.num_vacant;
        break;
      case SpaceState::kUnknown:
        ++street.num_unknown;
        break;
    }
  }
  return street;
}

double StreetTurnover::share() const { return share_of(num_left + num_came, num_known); }

StreetTurnover turnover(std::span<const ParkingSpace> spaces, std::span<const SpaceOccupancy> states,
                        const std::string& date) {
  StreetTurnover result;
  for (std::size_t i = 0; i < spaces.size(); ++i) {
    const SpaceState now = states[i].state, before = states[i].previous.value_or(SpaceState::kUnknown);
    if (spaces[i].is_candidate || now == SpaceState::kUnknown || before == SpaceState::kUnknown) continue;
    ++result.num_known;
    if (now != before) ++(now == SpaceState::kOccupied ? result.num_came : result.num_left);
    if (!result.days && !spaces[i].history.empty()) result.days = days_between(spaces[i].history.back().date, date);
  }
  return result;
}

std::optional<double> days_in_state(const ParkingSpace& space, SpaceState state, const std::string& date) {
  if (state == SpaceState::kUnknown) return std::nullopt;
  std::optional<double> days;
  for (auto past = space.history.rbegin(); past != space.history.rend() && past->state == state; ++past) {
    days = days_between(past->date, date);
  }
  return days ? days : days_between(date, date);
}

}  // namespace vdbmap::parking
