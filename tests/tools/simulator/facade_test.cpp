// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/facade.h"

#include <gtest/gtest.h>

#include "tools/simulator/ray_caster.h"

namespace vdbmap::simulator {
namespace {

double area(const Mesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3f a = mesh.vertices[t.a];
    sum += (mesh.vertices[t.b] - a).cross(mesh.vertices[t.c] - a).norm() / 2;
  }
  return sum;
}

TEST(Facade, WallHasItsAreaLessThatOfItsHoles) {
  Mesh mesh;
  const std::vector<WallPatch> holes = {{1, 2, 1, 2.5}, {3, 4.2, 0, 2.1}, {1, 2, 4, 5}};
  add_wall({&mesh}, {0, 6, -0.5, 7}, holes);
  EXPECT_NEAR(area(mesh), 6 * 7.5 - 1.5 - 1.2 * 2.1 - 1, 1e-4);
}

TEST(Facade, WindowsAreSetBackBehindTheWall) {
  const World world;
  Mesh mesh;
  Random random(1);
  const WallPatch hole = {1, 2.2, 1, 2.4};
  add_wall({&mesh}, {0, 4, 0, 4}, {hole});
  add_window({&mesh}, hole, 0.2, world.standard(), random);
  const RayCaster caster(mesh);
  const auto distance = [&](double x, double z) {
    return caster.first_hit({{x, -10, z}, Eigen::Vector3d::UnitY()})->distance;
  };
  EXPECT_NEAR(distance(0.5, 1.7), 10, 1e-5);      // the wall
  EXPECT_NEAR(distance(1.03, 1.7), 10.2, 1e-5);   // the frame
  EXPECT_NEAR(distance(1.3, 1.7), 10.225, 1e-5);  // the glass in the middle of the frame
}

TEST(Facade, DoorHasStepsThatReachItsFloor) {
  const World world;
  Mesh mesh;
  add_door({&mesh}, {1, 2.1, 0.55, 3}, 0.3, world.standard());
  const RayCaster caster(mesh);
  const auto height = [&](double y) {
    const auto hit = caster.first_hit({{1.5, y, 2}, -Eigen::Vector3d::UnitZ(), 0, 10});
    return hit ? 2 - hit->distance : -1;
  };
  EXPECT_NEAR(height(-0.1), 0.55, 1e-5);
  EXPECT_NEAR(height(-0.4), 0.38, 1e-5);
  EXPECT_NEAR(height(-0.7), 0.21, 1e-5);
  EXPECT_EQ(height(-1), -1);
}

}  // namespace
}  // namespace vdbmap::simulator
