// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/things/large_vehicles.h"

#include <gtest/gtest.h>

#include "tools/simulator/vehicle_model.h"

namespace vdbmap::simulator {
namespace {

constexpr double kMirrors = 0.3;  // [m] that they reach beyond a truck's side

struct Drawn {
  World world;
  Mesh mesh;
  Eigen::AlignedBox3d box;

  explicit Drawn(const VehicleShape& shape) {
    Random random(1);
    add_any_vehicle({&mesh, Eigen::Isometry3d::Identity(), world.add_paint(class_of(shape.body), random), 0}, shape,
                    world);
    for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(vertex.cast<double>());
  }
};

TEST(LargeVehicles, FillTheirBoxesStandOnTheGroundAndAreAllOfOneClass) {
  for (const VehicleBody body : {VehicleBody::kBoxVan, VehicleBody::kTruck, VehicleBody::kBus, VehicleBody::kCaravan,
                                 VehicleBody::kTrailer, VehicleBody::kMotorcycle}) {
    Random random(7);
    const VehicleShape shape = make_large_shape(body, 20, random);
    const Drawn vehicle(shape);
    EXPECT_NEAR(vehicle.box.min().z(), 0, 0.02) << name_of(body);
    EXPECT_NEAR(vehicle.box.sizes().x(), shape.length, 0.35) << name_of(body);
    EXPECT_LE(vehicle.box.sizes().y(), shape.width + 2 * kMirrors) << name_of(body);
    EXPECT_GE(vehicle.box.sizes().y(), 0.8 * shape.width) << name_of(body);
    EXPECT_NEAR(vehicle.box.max().z(), shape.height, 0.35) << name_of(body);
    for (const Triangle& t : vehicle.mesh.triangles) {
      ASSERT_EQ(vehicle.world.materials()[t.material].label, class_of(body)) << name_of(body);
    }
  }
}

TEST(LargeVehicles, AreChosenOnlyWhereTheyHaveRoom) {
  Random random(3);
  int num_trucks = 0, num_cars = 0;
  for (int i = 0; i < 400; ++i) {
    EXPECT_LE(make_any_shape(5.5, random).length, 5.5);
    const VehicleBody body = make_any_shape(9, random).body;
    num_trucks += body == VehicleBody::kTruck ? 1 : 0;
    num_cars += body < VehicleBody::kBoxVan ? 1 : 0;
  }
  EXPECT_GT(num_trucks, 60);
  EXPECT_GT(num_cars, 150);
}

TEST(LargeVehicles, DoorsOpenToTheirSideAndStayOnTheirHinge) {
  World world;
  Random random(4);
  const VehicleShape shape = make_vehicle_shape(6, random);
  for (const double side : {-1.0, 1.0}) {
    Mesh mesh;
    add_open_door({&mesh}, shape, side, 1.0, world.vehicle(SurfaceClass::kCar));
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(vertex.cast<double>());
    const double farthest = side > 0 ? box.max().y() : -box.min().y();
    EXPECT_NEAR(farthest, shape.width / 2 + 1.05 * std::sin(1.0), 0.05);
    EXPECT_NEAR(box.max().x(), 0.2 * shape.length, 0.05);  // the hinge
  }
}

}  // namespace
}  // namespace vdbmap::simulator
