// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/occupancy/occupancy.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "parking/ground_plan.h"
#include "tests/support/labelled_street.h"
#include "tests/support/threads.h"

namespace vdbmap::parking {
namespace {

using test::LabelledStreet;

// Three spaces along x, 6 m from each other, on level ground.
std::vector<ParkingSpace> row_of_spaces() {
  std::vector<ParkingSpace> spaces;
  for (const double x : {0.0, 6.0, 12.0}) {
    spaces.push_back(space_of_outline({{x - 2.8, -1}, {x + 2.8, -1}, {x + 2.8, 1}, {x - 2.8, 1}}));
    spaces.back().id = std::to_string(spaces.size());
  }
  return spaces;
}

LabelledStreet ground_alone() {
  LabelledStreet street;
  street.add_patch({-6, -6, 0.03}, {24, 12}, SurfaceClass::kGround);
  return street;
}

// Rays across a space, each row of them at another height.
std::vector<MeasuredRay> rays_across(double x, double low, double high) {
  std::vector<MeasuredRay> rays;
  for (double along = x - 2.7; along < x + 2.8; along += 0.1) {
    for (double z = low; z <= high; z += 0.1) rays.push_back({{along, -8, z}, {along, 8, z}});
  }
  return rays;
}

// What an epoch says, of which `now` is the map and `rays` passed.
std::vector<SpaceEvidence> look(const LabelledStreet& before, const LabelledStreet& now,
                                const std::vector<MeasuredRay>& rays) {
  const VoxelMap map_before = before.map(), map_now = now.map();
  const std::vector<ParkingSpace> spaces = row_of_spaces();
  const GroundPlan ground(map_before.finest());
  const auto rooms = rooms_over(spaces, ground);
  PassedColumns passed(rooms);
  passed.add(rays);
  return evidence_of(spaces, rooms, map_now.finest(), map_before.finest(), find_vehicles(map_now.finest()), passed);
}

TEST(Occupancy, IsOccupiedWhereAVehicleStands) {
  LabelledStreet now = ground_alone();
  now.add_body({6.3, 0.1}, 0.05);
  const std::vector<SpaceEvidence> evidence = look(ground_alone(), now, {});
  EXPECT_EQ(judge(evidence[1]).state, SpaceState::kOccupied);
  EXPECT_EQ(evidence[1].vehicle, 0U);
  EXPECT_EQ(judge(evidence[1]).occupant, Occupant::kVehicle);
  EXPECT_GT(evidence[1].vehicle_share, 0.9);
  EXPECT_GT(judge(evidence[1]).confidence, 0.9);
  EXPECT_EQ(judge(evidence[0]).state, SpaceState::kUnknown);
  EXPECT_EQ(judge(evidence[0]).reason, "not seen");
}

TEST(Occupancy, IsVacantOnlyWhereRaysPassed) {
  const std::vector<SpaceEvidence> evidence = look(ground_alone(), ground_alone(), rays_across(6, 0.5, 1.3));
  EXPECT_EQ(judge(evidence[1]).state, SpaceState::kVacant);
  EXPECT_EQ(judge(evidence[1]).confidence, 1);
  EXPECT_GT(evidence[1].rays_through, 100U);
  EXPECT_EQ(judge(evidence[2]).state, SpaceState::kUnknown);
  EXPECT_EQ(judge(evidence[2], {.as_paper = true}).state, SpaceState::kVacant);  // what the paper gets wrong
}

TEST(Occupancy, RaysOverBonnetsAndThroughWindowsAreNoProof) {
  const std::vector<SpaceEvidence> evidence = look(ground_alone(), ground_alone(), rays_across(6, 1.1, 1.4));
  EXPECT_EQ(evidence[1].num_passed, evidence[1].num_columns);
  EXPECT_EQ(evidence[1].num_passed_low, 0U);
  EXPECT_EQ(judge(evidence[1]).state, SpaceState::kUnknown);
}

// A body of a class from `low` on, from the ground up to `top` [m].
LabelledStreet with_thing(const Eigen::Vector2d& low, const Eigen::Vector2d& size, double top, SurfaceClass surface) {
  LabelledStreet street = ground_alone();
  for (double z = 0.2; z < top; z += 0.05) street.add_patch({low.x(), low.y(), z}, size, surface);
  return street;
}

TEST(Occupancy, AThingBesideWhichNoCarCanParkTakesIt) {
  const LabelledStreet now = with_thing({5, -0.4}, {2, 0.8}, 1.1, SurfaceClass::kOther);
  const std::vector<SpaceEvidence> evidence = look(ground_alone(), now, rays_across(6, 0.5, 1.3));
  EXPECT_EQ(evidence[1].vehicle_points, 0U);
  // The mean of voxels below its top, over a ground that is known to half a voxel.
  EXPECT_NEAR(evidence[1].thing_height, 1.05, 0.1);
  const SpaceOccupancy state = judge(evidence[1]);
  EXPECT_EQ(state.state, SpaceState::kOccupied);
  EXPECT_EQ(state.occupant, Occupant::kThing);
  const auto points = static_cast<double>(evidence[1].thing_points);
  EXPECT_DOUBLE_EQ(state.confidence, points / (points + 10));
  EXPECT_EQ(judge(evidence[0]).occupant, std::nullopt);
}

TEST(Occupancy, PlantsLeaveItUnknown) {
  const LabelledStreet now = with_thing({5, -0.8}, {2.5, 1.6}, 1.3, SurfaceClass::kVegetation);
  const std::vector<SpaceEvidence> evidence = look(ground_alone(), now, rays_across(6, 0.5, 1.3));
  EXPECT_EQ(evidence[1].thing_points, 0U);
  EXPECT_EQ(judge(evidence[1]).state, SpaceState::kUnknown);
  EXPECT_EQ(judge(evidence[1]).reason, "something stands there that is not known to be a vehicle");
}

// What lies flat, or along the kerb, leaves room for a car.
TEST(Occupancy, AThingThatLeavesRoomForACarDoesNotTakeIt) {
  for (const LabelledStreet& now : {with_thing({5, -0.4}, {2, 0.8}, 0.5, SurfaceClass::kOther),
                                    with_thing({3.3, 0.55}, {5, 0.4}, 1.2, SurfaceClass::kOther)}) {
    EXPECT_EQ(judge(look(ground_alone(), now, rays_across(6, 0.5, 1.3))[1]).state, SpaceState::kUnknown);
  }
}

TEST(Occupancy, AThingThatPassedByDoesNotTakeIt) {
  const LabelledStreet now = with_thing({5, -0.4}, {2, 0.8}, 1.1, SurfaceClass::kOther);
  SpaceEvidence space = look(ground_alone(), now, rays_across(6, 0.5, 1.3))[1];
  space.rays_through = 100 * space.thing_points;
  EXPECT_EQ(judge(space).state, SpaceState::kUnknown);
}

TEST(Occupancy, EachBoundOfThingsCounts) {
  const OccupancyRule rule;
  SpaceEvidence space;
  space.is_in_map = true;
  space.num_columns = 44;
  space.thing_points = rule.thing_points;
  space.num_with_thing = rule.thing_columns;
  space.thing_height = rule.thing_height;
  space.rays_through = static_cast<std::uint64_t>(static_cast<double>(rule.thing_points) / rule.thing_share);
  EXPECT_EQ(judge(space).occupant, Occupant::kThing);
  SpaceEvidence less = space;
  --less.thing_points;
  EXPECT_EQ(judge(less).state, SpaceState::kUnknown);
  less = space;
  --less.num_with_thing;
  EXPECT_EQ(judge(less).state, SpaceState::kUnknown);
  less = space;
  less.thing_height -= 0.01;
  EXPECT_EQ(judge(less).state, SpaceState::kUnknown);
  less = space;
  less.rays_through += 1;
  EXPECT_EQ(judge(less).state, SpaceState::kUnknown);
}

TEST(Occupancy, AVehicleThatStoodThereBeforeIsKnownAgain) {
  LabelledStreet before = ground_alone(), now = ground_alone();
  before.add_body({6, 0}, 0);
  for (double x = 4.5; x < 7.5; x += 0.05) {
    for (double z = 0.4; z < 0.9; z += 0.05) now.add({x, -0.88, z}, SurfaceClass::kOther);
  }
  EXPECT_EQ(judge(look(before, now, {})[1]).state, SpaceState::kOccupied);
  EXPECT_EQ(judge(look(ground_alone(), now, {})[1]).state, SpaceState::kUnknown);
}

TEST(Occupancy, ANeighborThatStandsOverTheLineTakesOneSpace) {
  LabelledStreet now = ground_alone();
  now.add_body({1.2, 0}, 0);  // reaches 0.2 m into the second
  const std::vector<SpaceEvidence> evidence = look(ground_alone(), now, rays_across(6, 0.5, 1.3));
  EXPECT_EQ(judge(evidence[0]).state, SpaceState::kOccupied);
  EXPECT_EQ(judge(evidence[1]).state, SpaceState::kVacant);
  EXPECT_GT(evidence[1].neighbor_points, 0U);
}

TEST(Occupancy, AVehicleThatPassedByDoesNotTakeIt) {
  LabelledStreet now = ground_alone();
  for (double z = 0.4; z < 1.2; z += 0.1) now.add_patch({5, -0.9, z}, {2, 0.1}, SurfaceClass::kVehicle);
  SpaceEvidence space = look(ground_alone(), now, rays_across(6, 0.4, 1.4))[1];
  EXPECT_EQ(judge(space).state, SpaceState::kOccupied);  // as many points as rays
  space.rays_through = 100 * space.vehicle_points;
  EXPECT_EQ(judge(space).state, SpaceState::kUnknown);
  EXPECT_NE(judge(space).reason.find("passed by"), std::string::npos);
}

TEST(Occupancy, OfAPlaceWithoutGroundNothingIsSaid) {
  LabelledStreet elsewhere;
  elsewhere.add_patch({100, 100, 0}, {10, 10}, SurfaceClass::kGround);
  const SpaceOccupancy state = judge(look(elsewhere, elsewhere, rays_across(6, 0.5, 1.3))[1]);
  EXPECT_EQ(state.state, SpaceState::kUnknown);
  EXPECT_EQ(state.reason, "the map has no ground there");
  EXPECT_EQ(judge(state.evidence, {.as_paper = true}).state, SpaceState::kUnknown);
}

TEST(Occupancy, PassesDoNotDependOnThreads) {
  const std::vector<MeasuredRay> rays = rays_across(5, 0.4, 1.6);
  const auto passes = [&] {
    const SpaceEvidence space = look(ground_alone(), ground_alone(), rays)[1];
    return std::tuple(space.num_passed, space.num_passed_low, space.rays_through);
  };
  const auto on_all = passes();
  const ThreadLimit one(1);
  EXPECT_EQ(passes(), on_all);
}

// Voxels that were seen to be empty, as a map keeps them.
TEST(Occupancy, AMapSaysWhatItsOwnRaysSaw) {
  const VoxelMap map = ground_alone().map();
  std::vector<VoxelIndex> empty;
  for (std::int32_t x = 30; x < 90; ++x) {
    for (std::int32_t y = -12; y < 12; ++y) {
      for (std::int32_t z = 4; z < 16; ++z) empty.emplace_back(x, y, z);
    }
  }
  const VoxelMap seen = test::map_of_voxels(empty);
  Visibility visibility;
  visibility.voxel_size = 0.1;
  visibility.seen_empty = seen.finest().tree();
  const std::vector<ParkingSpace> spaces = row_of_spaces();
  const auto rooms = rooms_over(spaces, GroundPlan(map.finest()));
  PassedColumns passed(rooms);
  passed.add(SightFinder(map.finest(), visibility), 0.1);
  const auto evidence = evidence_of(spaces, rooms, map.finest(), map.finest(), {}, passed);
  EXPECT_EQ(judge(evidence[1]).state, SpaceState::kVacant);
  EXPECT_EQ(evidence[1].num_passed, evidence[1].num_columns);
  EXPECT_EQ(judge(evidence[0]).state, SpaceState::kUnknown);
  EXPECT_EQ(judge(evidence[2]).state, SpaceState::kUnknown);
}

SpaceOccupancy state_of(SpaceState now, std::optional<SpaceState> before = std::nullopt) {
  SpaceOccupancy state;
  state.state = now;
  state.previous = before;
  return state;
}

TEST(StreetOccupancy, UnknownSpacesMakeItsIntervalWide) {
  std::vector<ParkingSpace> spaces(5);
  spaces[4].is_candidate = true;
  const std::vector<SpaceOccupancy> states = {state_of(SpaceState::kOccupied), state_of(SpaceState::kOccupied),
                                              state_of(SpaceState::kVacant), state_of(SpaceState::kUnknown),
                                              state_of(SpaceState::kVacant)};
  const StreetOccupancy street = street_occupancy(spaces, states);
  EXPECT_EQ(street.num_spaces(), 4U);
  EXPECT_DOUBLE_EQ(street.low(), 0.5);
  EXPECT_DOUBLE_EQ(street.high(), 0.75);
  EXPECT_DOUBLE_EQ(*street.known(), 2.0 / 3);
  EXPECT_FALSE(street_occupancy(std::vector<ParkingSpace>(1), std::vector{state_of(SpaceState::kUnknown)}).known());
}

TEST(StreetTurnover, CountsSpacesKnownInBothEpochs) {
  std::vector<ParkingSpace> spaces(4);
  spaces[0].history = {{"2023-03-01", SpaceState::kOccupied}};
  const auto kO = SpaceState::kOccupied, kV = SpaceState::kVacant, kU = SpaceState::kUnknown;
  const std::vector<SpaceOccupancy> states = {state_of(kV, kO), state_of(kO, kV), state_of(kO, kU), state_of(kO, kO)};
  const StreetTurnover change = turnover(spaces, states, "2023-03-03");
  EXPECT_EQ(change.num_known, 3U);
  EXPECT_EQ(change.num_left, 1U);
  EXPECT_EQ(change.num_came, 1U);
  EXPECT_DOUBLE_EQ(change.share(), 2.0 / 3);
  EXPECT_DOUBLE_EQ(*change.days, 2);
}

TEST(StreetTurnover, SaysForHowLongASpaceIsAsItIs) {
  ParkingSpace space;
  space.history = {{"2023-03-01", SpaceState::kVacant},
                   {"2023-03-02", SpaceState::kOccupied},
                   {"2023-03-04T12:00", SpaceState::kOccupied}};
  EXPECT_DOUBLE_EQ(*days_in_state(space, SpaceState::kOccupied, "2023-03-05"), 3);
  EXPECT_DOUBLE_EQ(*days_in_state(space, SpaceState::kVacant, "2023-03-05"), 0);
  EXPECT_FALSE(days_in_state(space, SpaceState::kUnknown, "2023-03-05"));
  EXPECT_FALSE(days_in_state(space, SpaceState::kOccupied, ""));
}

TEST(OccupancyRule, RefusesSharesThatAreNone) {
  EXPECT_THROW(OccupancyRule{.passed_share = 1.5}.check(), std::invalid_argument);
  EXPECT_THROW(OccupancyRule{.thing_share = -0.1}.check(), std::invalid_argument);
  EXPECT_NO_THROW(OccupancyRule{}.check());
}

}  // namespace
}  // namespace vdbmap::parking
