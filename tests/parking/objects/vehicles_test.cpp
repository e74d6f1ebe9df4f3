// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/objects/vehicles.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/support/labelled_street.h"
#include "tests/support/sample_maps.h"

namespace vdbmap::parking {
namespace {

using test::LabelledStreet;

std::vector<Vehicle> vehicles_of(const LabelledStreet& street) { return find_vehicles(street.map().finest()); }

void expect_body(const Vehicle& vehicle, const Eigen::Vector2d& middle, double heading) {
  EXPECT_LT((vehicle.box.center.head<2>() - middle).norm(), 0.15);
  EXPECT_LT(std::abs(std::remainder(vehicle.box.heading - heading, std::numbers::pi)), 3 * std::numbers::pi / 180);
  EXPECT_NEAR(vehicle.box.length, 4.4, 0.3);
  EXPECT_NEAR(vehicle.box.width, 1.8, 0.2);
  EXPECT_EQ(vehicle.doubt, "");
}

TEST(Vehicles, StandWhereTheyStand) {
  LabelledStreet street;
  street.add_body({3, 2}, 0.3);
  street.add_body({-9, 6}, 2.1);
  const std::vector<Vehicle> vehicles = vehicles_of(street);
  ASSERT_EQ(vehicles.size(), 2U);
  const bool is_first = vehicles[0].box.center.x() > 0;
  expect_body(vehicles[is_first ? 0 : 1], {3, 2}, 0.3);
  expect_body(vehicles[is_first ? 1 : 0], {-9, 6}, 2.1);
  EXPECT_FALSE(vehicles[0].is_completed);
  EXPECT_GT(vehicles[0].num_points, vehicles[0].num_voxels);
}

TEST(Vehicles, BumperToBumperAreTwo) {
  LabelledStreet street;
  street.add_body({0, 0}, 0);
  street.add_body({4.8, 0}, 0);  // 0.4 m between
  const std::vector<Vehicle> vehicles = vehicles_of(street);
  ASSERT_EQ(vehicles.size(), 2U);
  for (const Vehicle& vehicle : vehicles) {
    expect_body(vehicle, {vehicle.box.center.x() < 2 ? 0 : 4.8, 0}, 0);
  }
}

TEST(Vehicles, SideBySideAreAsManyAsTheyAre) {
  LabelledStreet street;
  for (const double y : {0.0, 2.2, 4.4}) street.add_body({0, y}, 0);
  EXPECT_EQ(vehicles_of(street).size(), 3U);
}

TEST(Vehicles, SeenInTwoPartsAreOne) {
  LabelledStreet street;
  street.add_body({0, 0}, 0.2, [](double along, double, double) { return std::abs(along) > 0.2; });
  const std::vector<Vehicle> vehicles = vehicles_of(street);
  ASSERT_EQ(vehicles.size(), 1U);
  expect_body(vehicles[0], {0, 0}, 0.2);
}

// The ground before it was seen, what is behind it is hidden.
TEST(Vehicles, SeenFromOneSideAreAsWideAsCarsAre) {
  for (const double side : {-1.0, 1.0}) {
    LabelledStreet street;
    street.add_body({0, 0}, 0, [&](double, double across, double) { return side * across > 0.5; });
    street.add_ground(-6, 6, [&](double, double y) { return side * y > 0.95; });
    const std::vector<Vehicle> vehicles = vehicles_of(street);
    ASSERT_EQ(vehicles.size(), 1U);
    EXPECT_TRUE(vehicles[0].is_completed);
    expect_body(vehicles[0], {0, 0}, 0);
  }
}

TEST(Vehicles, SeenFromBehindAreAsLongAsCarsAre) {
  LabelledStreet street;
  street.add_body({0, 0}, 0, [](double along, double, double) { return along < -1.4; });
  street.add_ground(-6, 6, [](double x, double) { return x < -2.25; });
  const std::vector<Vehicle> vehicles = vehicles_of(street);
  ASSERT_EQ(vehicles.size(), 1U);
  EXPECT_TRUE(vehicles[0].is_completed);
  EXPECT_LT(vehicles[0].box.center.head<2>().norm(), 0.2);
}

TEST(Vehicles, OfOtherSizesAreDoubted) {
  LabelledStreet street;
  street.add_body({0, 0}, 0, [](double, double, double z) { return z < 0.6; });
  const std::vector<Vehicle> vehicles = vehicles_of(street);
  ASSERT_EQ(vehicles.size(), 1U);
  EXPECT_EQ(vehicles[0].doubt.substr(0, 6), "height");
}

TEST(Vehicles, NeedLabels) {
  EXPECT_THROW(find_vehicles(test::map_of_voxels({{0, 0, 0}}).finest()), std::invalid_argument);
}

}  // namespace
}  // namespace vdbmap::parking
