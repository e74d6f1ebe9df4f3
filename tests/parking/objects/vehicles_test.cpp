// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/objects/vehicles.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "parking/segmentation/surface_class.h"
#include "tests/support/sample_maps.h"

namespace vdbmap::parking {
namespace {

// A street of ground and of bodies that are boxes with a lower bonnet, labelled.
class LabelledStreet {
 public:
  // A body of 4.4 x 1.8 m, of which only what `is_seen`(along, across, height) says is there.
  template <typename IsSeen>
  void add_body(const Eigen::Vector2d& middle, double heading, const IsSeen& is_seen) {
    const Eigen::Vector2d along(std::cos(heading), std::sin(heading)), across(-along.y(), along.x());
    for (double a = -2.2; a <= 2.2001; a += 0.05) {
      for (double c = -0.9; c <= 0.9001; c += 0.05) {
        const double top = a > 1.0 ? 0.9 : 1.4;
        for (double z = 0.2; z <= top + 0.001; z += 0.05) {
          const bool is_skin = std::abs(a) > 2.14 || std::abs(c) > 0.84 || z > top - 0.06;
          if (!is_skin || !is_seen(a, c, z)) continue;
          const Eigen::Vector2d place = middle + a * along + c * across;
          add({place.x(), place.y(), z}, SurfaceClass::kVehicle);
        }
      }
    }
  }

  void add_body(const Eigen::Vector2d& middle, double heading) {
    add_body(middle, heading, [](double, double, double) { return true; });
  }

  template <typename IsSeen>
  void add_ground(double low, double high, const IsSeen& is_seen) {
    for (double x = low; x < high; x += 0.09) {
      for (double y = low; y < high; y += 0.09) {
        if (is_seen(x, y)) add({x, y, 0.03}, SurfaceClass::kGround);
      }
    }
  }

  std::vector<Vehicle> vehicles() const {
    PointCloud cloud = cloud_;
    for (const SurfaceClass surface : classes_) cloud.labels.push_back(semantic_kitti_label(surface));
    return find_vehicles(test::fine_map_of(cloud).finest());
  }

 private:
  void add(const Eigen::Vector3d& point, SurfaceClass surface) {
    cloud_.positions.push_back(point);
    classes_.push_back(surface);
  }

  PointCloud cloud_;
  std::vector<SurfaceClass> classes_;
};

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
  const std::vector<Vehicle> vehicles = street.vehicles();
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
  const std::vector<Vehicle> vehicles = street.vehicles();
  ASSERT_EQ(vehicles.size(), 2U);
  for (const Vehicle& vehicle : vehicles) {
    expect_body(vehicle, {vehicle.box.center.x() < 2 ? 0 : 4.8, 0}, 0);
  }
}

TEST(Vehicles, SideBySideAreAsManyAsTheyAre) {
  LabelledStreet street;
  for (const double y : {0.0, 2.2, 4.4}) street.add_body({0, y}, 0);
  EXPECT_EQ(street.vehicles().size(), 3U);
}

TEST(Vehicles, SeenInTwoPartsAreOne) {
  LabelledStreet street;
  street.add_body({0, 0}, 0.2, [](double along, double, double) { return std::abs(along) > 0.2; });
  const std::vector<Vehicle> vehicles = street.vehicles();
  ASSERT_EQ(vehicles.size(), 1U);
  expect_body(vehicles[0], {0, 0}, 0.2);
}

// The ground before it was seen, what is behind it is hidden.
TEST(Vehicles, SeenFromOneSideAreAsWideAsCarsAre) {
  for (const double side : {-1.0, 1.0}) {
    LabelledStreet street;
    street.add_body({0, 0}, 0, [&](double, double across, double) { return side * across > 0.5; });
    street.add_ground(-6, 6, [&](double, double y) { return side * y > 0.95; });
    const std::vector<Vehicle> vehicles = street.vehicles();
    ASSERT_EQ(vehicles.size(), 1U);
    EXPECT_TRUE(vehicles[0].is_completed);
    expect_body(vehicles[0], {0, 0}, 0);
  }
}

TEST(Vehicles, SeenFromBehindAreAsLongAsCarsAre) {
  LabelledStreet street;
  street.add_body({0, 0}, 0, [](double along, double, double) { return along < -1.4; });
  street.add_ground(-6, 6, [](double x, double) { return x < -2.25; });
  const std::vector<Vehicle> vehicles = street.vehicles();
  ASSERT_EQ(vehicles.size(), 1U);
  EXPECT_TRUE(vehicles[0].is_completed);
  EXPECT_LT(vehicles[0].box.center.head<2>().norm(), 0.2);
}

TEST(Vehicles, OfOtherSizesAreDoubted) {
  LabelledStreet street;
  street.add_body({0, 0}, 0, [](double, double, double z) { return z < 0.6; });
  const std::vector<Vehicle> vehicles = street.vehicles();
  ASSERT_EQ(vehicles.size(), 1U);
  EXPECT_EQ(vehicles[0].doubt.substr(0, 6), "height");
}

TEST(Vehicles, NeedLabels) {
  EXPECT_THROW(find_vehicles(test::map_of_voxels({{0, 0, 0}}).finest()), std::invalid_argument);
}

}  // namespace
}  // namespace vdbmap::parking
