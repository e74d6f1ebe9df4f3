// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/vehicle_model.h"

#include <map>

#include <gtest/gtest.h>

#include "tools/simulator/ray_caster.h"

namespace vdbmap::simulator {
namespace {

constexpr double kProud = 0.008;  // [m] that wheels, lights and plates stand out of the body

struct DrawnVehicle {
  World world;
  Mesh mesh;

  explicit DrawnVehicle(const VehicleShape& shape) {
    const MaterialId paint = world.add_material({SurfaceClass::kCar, Eigen::Vector3f(1, 1, 1)});
    add_vehicle({&mesh, Eigen::Isometry3d::Identity(), paint, 0}, shape, world.standard());
  }
};

std::map<VehicleBody, VehicleShape> one_of_each_body() {
  std::map<VehicleBody, VehicleShape> shapes;
  Random random(1);
  while (shapes.size() < 6) {
    const VehicleShape shape = make_vehicle_shape(10, random);
    shapes.emplace(shape.body, shape);
  }
  return shapes;
}

TEST(VehicleModel, FillsItsBoxAndOnlyMirrorsLeaveIt) {
  for (const auto& [body, shape] : one_of_each_body()) {
    const DrawnVehicle vehicle(shape);
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3f& vertex : vehicle.mesh.vertices) box.extend(vertex.cast<double>());
    EXPECT_NEAR(box.sizes().x(), shape.length, 2 * kProud) << name_of(body);
    EXPECT_NEAR(box.sizes().z(), shape.height, 1e-4) << name_of(body);
    EXPECT_NEAR(box.min().z(), 0, 1e-5) << name_of(body);
    EXPECT_NEAR(box.sizes().y(), shape.width + 2 * 0.14, 1e-4) << name_of(body);  // mirrors stand out 14 cm
    EXPECT_NEAR(box.center().x(), 0, kProud) << name_of(body);
  }
}

TEST(VehicleModel, HasTheSizesOfRealCars) {
  Random random(2);
  for (int i = 0; i < 500; ++i) {
    const VehicleShape shape = make_vehicle_shape(10, random);
    EXPECT_GT(shape.length, 3.7);
    EXPECT_LT(shape.length, 5.9);
    EXPECT_GT(shape.width, 1.69);
    EXPECT_LT(shape.width, 2.02);
    EXPECT_GT(shape.height, 1.39);
    EXPECT_LT(shape.height, 2.45);
  }
}

// Level, through the middle of the cabin: the side windows are glass, the sheet below them is not.
TEST(VehicleModel, LightEntersThroughTheSideWindowsOnly) {
  for (const auto& [body, shape] : one_of_each_body()) {
    if (body == VehicleBody::kVan) continue;  // panels behind the front doors
    const DrawnVehicle vehicle(shape);
    const RayCaster caster(vehicle.mesh);
    const auto material_at = [&](double height) {
      const auto hit = caster.first_hit({{0.25, -5, height}, Eigen::Vector3d::UnitY()});
      return hit ? vehicle.world.materials()[vehicle.mesh.triangles[hit->triangle].material] : Material{};
    };
    EXPECT_GT(material_at(0.85 * shape.height).transmission, 0.5F) << name_of(body);
    EXPECT_EQ(material_at(0.5 * shape.height).transmission, 0.0F) << name_of(body);
  }
}

TEST(VehicleModel, NothingLiesBelowTheBodyButWheels) {
  const VehicleShape shape = one_of_each_body().at(VehicleBody::kEstate);
  const DrawnVehicle vehicle(shape);
  const RayCaster caster(vehicle.mesh);
  EXPECT_FALSE(caster.first_hit({{0, -5, 0.1}, Eigen::Vector3d::UnitY()}));
  EXPECT_TRUE(caster.first_hit({{shape.wheelbase / 2, -5, 0.1}, Eigen::Vector3d::UnitY()}));
}

}  // namespace
}  // namespace vdbmap::simulator
