// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "parking/occupancy/space_evidence.h"
#include "parking/spaces/parking_space.h"

namespace vdbmap::parking {

/// When a space counts as occupied or vacant.
struct OccupancyRule {
  bool as_paper = false;              ///< Mortazavi 2023: no vehicle point inside is vacant, any is occupied
  double passed_share = 0.6;          ///< of the columns, that rays must have passed for a space to be vacant
  double low_share = 0.5;             ///< of the columns, that they must have passed below the windows of cars
  double other_share = 0.1;           ///< of the columns: more that hold other things, and it is not vacant
  std::uint64_t many_rays = 1000;     ///< through it; of a space that fewer passed, things are hardly seen: none may be
  std::uint64_t stray_points = 2;     ///< of vehicles: more, and it is not vacant
  std::uint64_t vehicle_points = 10;  ///< inside, of vehicles that stand there, for it to be occupied
  std::size_t vehicle_columns = 3;    ///< in which they lie
  /// Of the rays through a space whose columns are nearly all passed below windows, so many points at least, for it to
  /// be occupied: fewer are left by a vehicle that passed by.
  double standing_share = 0.02;
  /// What is no vehicle takes a space too, as a motorcycle or a skip does, where no car could park for it: so many
  /// points inside,
  std::uint64_t thing_points = 20;
  std::size_t thing_columns = 3;  ///< in so many inner columns,
  double thing_height = 0.6;      ///< so high [m],
  double thing_share = 0.02;      ///< and so many points of the rays through the space: it stands still

  /// Throws std::invalid_argument naming the value and what is allowed.
  void check() const;
};

/// What takes a space: a vehicle, or a thing that is not known to be one and beside which no car can park.
enum class Occupant { kVehicle, kThing };

/// "vehicle" or "thing".
std::string_view text_of(Occupant occupant);

/// The state of a space in an epoch.
struct SpaceOccupancy {
  SpaceState state = SpaceState::kUnknown;
  std::optional<Occupant> occupant;  ///< where it is occupied
  double confidence = 0;             ///< 0 to 1, see judge()
  std::string reason;                ///< why it is unknown; else empty
  SpaceEvidence evidence;
  std::optional<SpaceState> previous;  ///< in the epoch before, where there was one
};

/// Judges a space by what an epoch says of it. The confidence of an occupied space is n / (n + 10) for n points of the
/// vehicle or the thing, that of a vacant one the share of its columns that rays passed, less those in which something
/// stands; that of an unknown one is 0. By the paper's rule nothing tells more or less sure answers apart: 1.
SpaceOccupancy judge(const SpaceEvidence& evidence, const OccupancyRule& rule = {});

/// The occupancy of a street [0 to 1]: unknown spaces, which may be taken or not, make its interval wide.
struct StreetOccupancy {
  std::size_t num_occupied = 0, num_vacant = 0, num_unknown = 0;

  std::size_t num_spaces() const { return num_occupied + num_vacant + num_unknown; }
  double low() const;                   ///< where all unknown spaces are vacant
  double high() const;                  ///< where all are occupied
  std::optional<double> known() const;  ///< of the spaces whose state is known; nothing where none is
};

/// Without candidates.
StreetOccupancy street_occupancy(std::span<const ParkingSpace> spaces, std::span<const SpaceOccupancy> states);

/// What became of spaces since the epoch before.
struct StreetTurnover {
  std::size_t num_known = 0;   ///< spaces whose state is known in both epochs
  std::size_t num_left = 0;    ///< were occupied, are vacant
  std::size_t num_came = 0;    ///< were vacant, are occupied
  std::optional<double> days;  ///< between the epochs, where both have dates

  double share() const;  ///< of spaces whose state changed; 0 where none is known
};

/// `date` is that of the epoch (ISO 8601), empty where it is not known.
StreetTurnover turnover(std::span<const ParkingSpace> spaces, std::span<const SpaceOccupancy> states,
                        const std::string& date);

/// For how long a space is known to be in the state that it is in [days]: since the first of its last epochs in which
/// it had no other. Nothing without dates, and where the state is unknown.
std::optional<double> days_in_state(const ParkingSpace& space, SpaceState state, const std::string& date);

}  // namespace vdbmap::parking
