// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/ground_plan.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/support/labelled_street.h"

namespace vdbmap::parking {
namespace {

using test::LabelledStreet;

double slope_at(const Eigen::Vector2d& place) { return 3 + 0.04 * place.x() - 0.02 * place.y(); }

TEST(GroundPlan, FindsThePlaneUnderTheGround) {
  LabelledStreet street;
  for (double x = 0; x < 12; x += 0.05) {
    for (double y = 0; y < 12; y += 0.05) street.add({x, y, slope_at({x, y})}, SurfaceClass::kGround);
  }
  const GroundPlan ground(street.map().finest());
  const std::optional<GroundPlane> plane = ground.plane_around({6, 6}, 4);
  ASSERT_TRUE(plane);
  for (const Eigen::Vector2d& place : {Eigen::Vector2d(4, 5), Eigen::Vector2d(8, 8)}) {
    EXPECT_NEAR(plane->height_at(place), slope_at(place), 0.01);
    EXPECT_NEAR(*ground.height_at(place), slope_at(place), 0.02);
  }
  EXPECT_FALSE(ground.height_at({20, 6}));
  EXPECT_FALSE(ground.plane_around({40, 6}, 4));
  EXPECT_TRUE(ground.height_near({13, 6}, 2));
}

TEST(GroundPlan, SaysWhereSomethingStands) {
  LabelledStreet street;
  street.add_patch({0, 0, 0}, {6, 6}, SurfaceClass::kGround);
  street.add({1.2, 1.2, 1.0}, SurfaceClass::kPole);
  street.add({3.2, 1.2, 3.0}, SurfaceClass::kVegetation);
  street.add({5.2, 1.2, 1.0}, SurfaceClass::kVehicle);
  const GroundPlan ground(street.map().finest());
  EXPECT_TRUE(ground.is_blocked({1.1, 1.1}, 0));
  EXPECT_FALSE(ground.is_blocked({3.1, 1.1}, 0));
  EXPECT_FALSE(ground.is_blocked({5.1, 1.1}, 0));
}

TEST(GroundPlan, NeedsLabels) {
  EXPECT_THROW(GroundPlan(test::sample_map_without_attributes().finest()), std::invalid_argument);
}

}  // namespace
}  // namespace vdbmap::parking
