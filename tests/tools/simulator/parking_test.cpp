// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/parking.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace vdbmap::simulator {
namespace {

struct ParkedStreet {
  StreetLayout layout;
  World world;
  Parking parking;

  // An ideal one.
  explicit ParkedStreet(StreetOptions options) {
    options.is_ideal = true;
    layout = make_layout(options);
    parking = make_parking(world, layout, options);
  }
};

std::array<Eigen::Vector2d, 4> corners_of(const ParkedVehicle& vehicle) {
  std::array<Eigen::Vector2d, 4> corners;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d corner((i & 1 ? 0.5 : -0.5) * vehicle.shape.length,
                                 (i & 2 ? 0.5 : -0.5) * vehicle.shape.width, 0);
    corners[static_cast<std::size_t>(i)] = (vehicle.scene_from_vehicle * corner).head<2>();
  }
  return corners;
}

// Whether a line along an edge of `a` parts the two rectangles.
bool are_parted_by(const ParkedVehicle& a, const ParkedVehicle& b) {
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d direction = a.scene_from_vehicle.linear().col(axis).head<2>();
    const double half = (axis == 0 ? a.shape.length : a.shape.width) / 2;
    std::array<double, 4> places;
    std::ranges::transform(corners_of(b), places.begin(), [&](const Eigen::Vector2d& corner) {
      return direction.dot(corner - a.scene_from_vehicle.translation().head<2>());
    });
    if (*std::ranges::min_element(places) > half || *std::ranges::max_element(places) < -half) return true;
  }
  return false;
}

TEST(Parking, NoTwoCarsOfAnEpochTouch) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
    const ParkedStreet street({.seed = seed, .length = 300, .occupancy = 1});
    for (const auto& epoch : street.parking.vehicle_in_space) {
      std::vector<const ParkedVehicle*> vehicles;
      for (const auto& vehicle : epoch) {
        if (vehicle) vehicles.push_back(&street.parking.vehicles[*vehicle]);
      }
      for (std::size_t i = 0; i < vehicles.size(); ++i) {
        for (std::size_t k = i + 1; k < vehicles.size(); ++k) {
          EXPECT_TRUE(are_parted_by(*vehicles[i], *vehicles[k]) || are_parted_by(*vehicles[k], *vehicles[i]))
              << "seed " << seed << ", spaces " << vehicles[i]->space << " and " << vehicles[k]->space;
        }
      }
    }
  }
}

// Tolerances are four standard deviations of shares among the spaces of ten streets.
TEST(Parking, OccupancyAndTurnoverAreTheSharesAskedFor) {
  int num_spaces = 0, num_taken[2] = {0, 0}, num_left = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const ParkedStreet street({.seed = seed, .length = 500, .occupancy = 0.7, .turnover = 0.3});
    const auto& epochs = street.parking.vehicle_in_space;
    for (std::size_t i = 0; i < street.parking.spaces.size(); ++i) {
      ++num_spaces;
      for (const std::size_t epoch : {0, 1}) num_taken[epoch] += epochs[epoch][i] ? 1 : 0;
      num_left += epochs[0][i] && epochs[1][i] != epochs[0][i] ? 1 : 0;
    }
  }
  ASSERT_GT(num_spaces, 500);
  for (const int taken : num_taken) EXPECT_NEAR(double(taken) / num_spaces, 0.7, 4 * 0.458 / std::sqrt(num_spaces));
  EXPECT_NEAR(double(num_left) / num_taken[0], 0.3, 4 * 0.458 / std::sqrt(num_taken[0]));
}

TEST(Parking, CarsStandInTheirSpacesAndKeepTheirPlaceWhileTheyStay) {
  const ParkedStreet street({.seed = 3, .length = 300, .num_epochs = 4});
  for (const auto& epoch : street.parking.vehicle_in_space) {
    for (std::size_t i = 0; i < epoch.size(); ++i) {
      if (!epoch[i]) continue;
      const ParkedVehicle& vehicle = street.parking.vehicles[*epoch[i]];
      const ParkingSpace& space = street.parking.spaces[i];
      EXPECT_EQ(vehicle.space, i);
      const Eigen::Vector2d middle =
          street.layout.axis.point(space.station, street.layout.sides[space.side].sign * space.distance);
      EXPECT_LT((vehicle.scene_from_vehicle.translation().head<2>() - middle).norm(), 0.8);
    }
  }
}

TEST(Parking, WheelsStandOnTheGround) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const ParkedStreet street({.seed = seed});
    for (const ParkedVehicle& vehicle : street.parking.vehicles) {
      const Eigen::Isometry3d& frame = vehicle.scene_from_vehicle;
      const ParkingSpace& space = street.parking.spaces[vehicle.space];
      const SideLayout& side = street.layout.sides[space.side];
      const double ground = street.layout.ground_height(space.station, side.sign * space.distance);
      EXPECT_NEAR(frame.translation().z(), ground, 0.09);  // between road and kerb where it stands on both
      const double roll = std::asin(frame.linear()(2, 1));
      const bool is_half = side.parking == ParkingKind::kHalfOnPavement;
      EXPECT_LT(std::abs(roll), is_half ? 0.12 : 0.06);
    }
  }
}

TEST(Parking, EmptyAndFullStreetsAreWhatTheySay) {
  const ParkedStreet empty({.occupancy = 0});
  EXPECT_TRUE(empty.parking.vehicles.empty());
  const ParkedStreet full({.occupancy = 1, .turnover = 1});
  for (const auto& epoch : full.parking.vehicle_in_space) {
    EXPECT_TRUE(std::ranges::all_of(epoch, [](const auto& vehicle) { return vehicle.has_value(); }));
  }
  EXPECT_EQ(full.parking.vehicles.size(), 2 * full.parking.spaces.size());
}

}  // namespace
}  // namespace vdbmap::simulator
