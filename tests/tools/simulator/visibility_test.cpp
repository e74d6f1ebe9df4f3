// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/visibility.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace vdbmap::simulator {
namespace {

// A street's spaces in an empty scene; a sensor that sees all around.
struct EmptyScene {
  Street street = make_street({.length = 40, .margin = 5, .num_epochs = 1, .occupancy = 0, .is_ideal = true});
  Drive drive{street.layouts.front(), {.from = 0, .to = 40}};
  FieldOfView field;
  Mesh mesh;
  std::vector<Material> materials = {{SurfaceClass::kBuilding, Eigen::Vector3f(1, 1, 1)}};

  EmptyScene() { field.vehicle_from_sensor = Eigen::Translation3d(0, 0, 2); }

  // Around the middle of the first space, with room for all of it.
  Brush around_first_space() {
    const ParkingSpace& space = street.parking.spaces.front();
    const StreetLayout& layout = street.layouts.front();
    return {&mesh, layout.place(space.station, layout.sides[space.side].sign * space.distance, space.yaw), 0, 9};
  }

  std::vector<double> shares() const {
    const RayCaster caster(mesh);
    return space_visibility(street, 0, {mesh, materials, caster}, drive, field);
  }
};

TEST(Visibility, NothingHidesSpacesInAnEmptyScene) {
  EmptyScene scene;
  add_triangle({&scene.mesh}, {0, 0, -90}, {1, 0, -90}, {0, 1, -90});  // far below
  for (const double share : scene.shares()) EXPECT_EQ(share, 1);
}

TEST(Visibility, WallsHideWhatTheyEncloseAndNothingElse) {
  EmptyScene scene;
  add_box(scene.around_first_space(), {-2.8, -1.3, -1}, {2.8, 1.3, 2});
  const std::vector<double> shares = scene.shares();
  EXPECT_EQ(shares.front(), 0);
  EXPECT_EQ(shares.back(), 1);
}

TEST(Visibility, WhatStandsInASpaceHidesNothingOfIt) {
  EmptyScene scene;
  scene.street.parking.thing_in_space = {
      std::vector<std::optional<ObjectId>>(scene.street.parking.spaces.size(), ObjectId(9))};
  add_box(scene.around_first_space(), {-2.8, -1.3, -1}, {2.8, 1.3, 2});
  EXPECT_EQ(scene.shares().front(), 1);
}

TEST(Visibility, EndsWithRangeAndFieldOfView) {
  EmptyScene scene;
  add_triangle({&scene.mesh}, {0, 0, -90}, {1, 0, -90}, {0, 1, -90});
  scene.field.farthest = 1;
  for (const double share : scene.shares()) EXPECT_EQ(share, 0);
  scene.field.farthest = 60;
  scene.field.lowest = 0.1;  // above the horizon only
  for (const double share : scene.shares()) EXPECT_EQ(share, 0);
}

}  // namespace
}  // namespace vdbmap::simulator
