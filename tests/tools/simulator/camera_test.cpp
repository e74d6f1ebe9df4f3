// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/camera.h"

#include <gtest/gtest.h>

#include "tests/tools/simulator/simple_scene.h"

namespace vdbmap::simulator {
namespace {

// Sun from above on level ground; then a roof over it.
TEST(Camera, ShadowsAreDarkerAndBluer) {
  SimpleScene scene;
  const Brush brush = scene.brush(0.5F);
  add_quad(brush, {-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0});
  const auto color = [&] {
    const RayCaster caster(scene.mesh);
    RayRandom random(1);
    const Echo echo = {1, 0, Eigen::Vector3d::UnitZ(), 0.5};
    return color_of({scene.mesh, scene.materials, caster}, Daylight{{0, 0, 1}}, Eigen::Vector3d::Zero(), echo, random);
  };
  const Rgb16 lit = color();
  add_quad(brush, {-5, -5, 3}, {5, -5, 3}, {5, 5, 3}, {-5, 5, 3});
  const Rgb16 dark = color();
  EXPECT_LT(dark.g, 0.8 * lit.g);
  EXPECT_GT(double(dark.b) / dark.r, double(lit.b) / lit.r);
}

TEST(Camera, DropsOfRainAreGreyThoughTheyAreNoSurface) {
  SimpleScene scene;
  add_quad(scene.brush(0.5F), {-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0});
  const RayCaster caster(scene.mesh);
  RayRandom random(1);
  const Echo drop = {5, kNoTriangle, Eigen::Vector3d::UnitX(), 0.03};
  const Rgb16 color =
      color_of({scene.mesh, scene.materials, caster}, Daylight{{0, 0, 1}}, Eigen::Vector3d(5, 0, 1), drop, random);
  EXPECT_NEAR(color.r, color.b, 0.1 * color.b);
  EXPECT_GT(color.g, 20000);
}

}  // namespace
}  // namespace vdbmap::simulator
