// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/spaces/find_spaces.h"

#include <algorithm>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "tests/support/labelled_street.h"

namespace vdbmap::parking {
namespace {

using std::numbers::pi;
using test::LabelledStreet;

constexpr double kKerb = 4;  // [m] of the middle of the parked cars from that of the road

// A road along x with pavements 0.12 m higher behind parked cars: four on its north side with a gap of one after the
// second, three on its south side.
LabelledStreet road() {
  LabelledStreet street;
  for (const double x : {0.0, 5.6, 17.0, 22.6}) street.add_body({x, kKerb}, 0);
  for (const double x : {1.0, 6.6, 12.2}) street.add_body({x, -kKerb}, pi);
  street.add_patch({-8, -kKerb - 1.2, 0.03}, {40, 2 * kKerb + 2.4}, SurfaceClass::kGround);
  street.add_patch({-8, kKerb + 1.2, 0.15}, {40, 3}, SurfaceClass::kGround);
  street.add_patch({-8, -kKerb - 4.2, 0.15}, {40, 3}, SurfaceClass::kGround);
  return street;
}

std::vector<const ParkingSpace*> on_side(const FoundSpaces& found, const std::string& side, bool are_candidates) {
  std::vector<const ParkingSpace*> spaces;
  for (const ParkingSpace& space : found.spaces) {
    if (space.kerb_side == side && space.is_candidate == are_candidates) spaces.push_back(&space);
  }
  return spaces;
}

std::set<std::string> ids_of(const std::vector<ParkingSpace>& spaces) {
  std::set<std::string> ids;
  for (const ParkingSpace& space : spaces) ids.insert(space.id);
  return ids;
}

TEST(FindSpaces, MakesOneOfEachVehicleOnItsSideOfTheRoad) {
  const FoundSpaces found = find_spaces(road().map().finest(), {.date = "2023-03-01", .known = {}});
  EXPECT_EQ(found.num_vehicles, 7U);
  EXPECT_EQ(found.num_new, 7U);
  EXPECT_EQ(on_side(found, "N", false).size(), 4U);
  EXPECT_EQ(on_side(found, "S", false).size(), 3U);
  EXPECT_EQ(ids_of(found.spaces).size(), found.spaces.size());
  for (const ParkingSpace& space : found.spaces) {
    EXPECT_EQ(space.angle, ParkingAngle::kParallel) << space.id;
    ASSERT_EQ(space.history.size(), space.is_candidate ? 0U : 1U);
    if (space.is_candidate) continue;
    EXPECT_NEAR(space.length, 4.4, 0.2);
    EXPECT_NEAR(*space.ground, 0.03, 0.1);
    EXPECT_EQ(space.history[0].state, SpaceState::kOccupied);
    EXPECT_EQ(space.history[0].date, "2023-03-01");
  }
}

TEST(FindSpaces, OffersFreeKerbThatIsLongEnough) {
  const FoundSpaces found = find_spaces(road().map().finest());
  const std::vector<const ParkingSpace*> candidates = on_side(found, "N", true);
  ASSERT_EQ(candidates.size(), 1U);  // of 7.0 m between 7.8 m and 14.8 m
  const UprightBox box = box_of(*candidates[0]);
  EXPECT_NEAR(box.center.x(), 11.3, 0.2);
  EXPECT_NEAR(box.center.y(), kKerb, 0.2);
  EXPECT_GE(box.length, 5.2);
}

TEST(FindSpaces, OffersNoKerbOnWhichSomethingStands) {
  LabelledStreet street = road();
  for (double z = 0.2; z < 2; z += 0.05) {
    street.add_patch({10.5, kKerb - 0.4, z}, {1, 0.6}, SurfaceClass::kVegetation);
  }
  EXPECT_TRUE(on_side(find_spaces(street.map().finest()), "N", true).empty());
}

TEST(FindSpaces, KnowsSpacesAgainByTheirIds) {
  const FoundSpaces first = find_spaces(road().map().finest(), {.date = "2023-03-01", .known = {}});
  LabelledStreet later;  // one car a little farther, the candidate taken, one car in a place of its own
  later.add_body({0.4, kKerb}, 0);
  later.add_body({11.3, kKerb}, 0);
  later.add_body({30, kKerb}, 0);
  later.add_patch({-8, -8, 0.03}, {44, 16}, SurfaceClass::kGround);
  const FoundSpaces second = find_spaces(later.map().finest(), {.date = "2023-03-02", .known = first.spaces});
  EXPECT_EQ(second.num_new, 1U);
  EXPECT_EQ(second.num_seen_again, 2U);
  for (const ParkingSpace& before : first.spaces) {
    const auto now = std::ranges::find(second.spaces, before.id, &ParkingSpace::id);
    ASSERT_NE(now, second.spaces.end()) << before.id;
    EXPECT_LT((box_of(*now).center - box_of(before).center).norm(), 0.2);
    if (before.is_candidate) {
      EXPECT_FALSE(now->is_candidate);
    } else {
      EXPECT_EQ(now->outline, before.outline);
    }
  }
  EXPECT_EQ(ids_of(second.spaces).size(), second.spaces.size());
}

TEST(FindSpaces, LeavesOutWhatStandsInTheLane) {
  LabelledStreet street = road();
  street.add_body({8, 0.3}, 0);
  const FoundSpaces found = find_spaces(street.map().finest());
  EXPECT_EQ(found.num_vehicles, 8U);
  EXPECT_EQ(found.num_new, 7U);
  EXPECT_EQ(found.doubts, std::vector<std::string>{"stands in the lane"});
}

TEST(FindSpaces, TellsCarsBesideEachOtherFromCarsInARow) {
  LabelledStreet street;
  for (int i = 0; i < 6; ++i) street.add_body({2.6 * i, kKerb + 1}, pi / 2);
  street.add_patch({-8, -8, 0.03}, {32, 20}, SurfaceClass::kGround);
  for (const ParkingSpace& space : find_spaces(street.map().finest()).spaces) {
    EXPECT_EQ(space.angle, ParkingAngle::kPerpendicular) << space.id;
  }
}

TEST(FindSpaces, FindsNoneWhereThereIsNoVehicle) {
  LabelledStreet street;
  street.add_patch({0, 0, 0.03}, {20, 20}, SurfaceClass::kGround);
  EXPECT_TRUE(find_spaces(street.map().finest()).spaces.empty());
}

TEST(FindSpaces, SaysWhichLieOnEachOther) {
  const auto space = [](double x) { return space_of_outline({{x, 0}, {x + 5, 0}, {x + 5, 2}, {x, 2}}); };
  const std::vector<ParkingSpace> spaces = {space(0), space(4), space(8.8)};
  const std::vector<SpaceOverlap> overlaps = find_overlaps(spaces);
  ASSERT_EQ(overlaps.size(), 1U);
  EXPECT_EQ(overlaps[0].a, 0U);
  EXPECT_EQ(overlaps[0].b, 1U);
  EXPECT_NEAR(overlaps[0].share, 0.2, 1e-9);
}

}  // namespace
}  // namespace vdbmap::parking
