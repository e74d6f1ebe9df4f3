// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/mapper.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/threads.h"
#include "tests/tools/simulator/simple_scene.h"

namespace vdbmap::simulator {
namespace {

const Eigen::Vector3d kOrigin(550'000, 5'802'000, 55);

// Level ground under a short drive.
struct GroundAndDrive {
  GroundAndDrive() {
    const Eigen::Vector3d p = drive.scene_from_vehicle(0).translation();
    ground = p.z() - 0.5;
    const Brush brush = scene.brush(0.5F);
    add_quad(brush, {p.x() - 40, p.y() - 40, ground}, {p.x() + 40, p.y() - 40, ground},
             {p.x() + 40, p.y() + 40, ground}, {p.x() - 40, p.y() + 40, ground});
  }

  Survey map(const MapperModel& mapper) const {
    const RayCaster caster(scene.mesh);
    return map_street({scene.mesh, scene.materials, caster}, drive, mapper, Daylight{{0, 0, 1}}, kOrigin, 1);
  }

  StreetLayout layout = make_layout({.is_ideal = true});
  Drive drive{layout, {.from = 80, .to = 82}};
  SimpleScene scene;
  double ground = 0;
};

TEST(Mapper, SendsSixHundredThousandPulsesASecondInPlanesThatCross) {
  const MapperModel mapper = vmx250();
  EXPECT_NEAR(2 * mapper.line_rate * mapper.pulses_per_line, 600e3, 1e-6);
  const Eigen::Vector3d a = mapper.vehicle_from_scanner[0].linear().col(0);
  const Eigen::Vector3d b = mapper.vehicle_from_scanner[1].linear().col(0);
  EXPECT_LT(std::abs(a.dot(b)), 0.5);  // at more than 60 degrees
  EXPECT_NEAR(a.y(), -b.y(), 1e-12);   // left and right alike
  EXPECT_NEAR(mapper.direction(750).z(), 1, 1e-12);
}

TEST(Mapper, NoiseFreePointsLieOnTheGround) {
  const GroundAndDrive ground;
  MapperModel mapper = vmx250();
  mapper.pulse = {.nearest = 1, .farthest = 30};
  const Survey survey = ground.map(mapper);
  ASSERT_GT(survey.cloud.size(), 10'000U);
  for (const Eigen::Vector3d& p : survey.cloud.positions) ASSERT_NEAR(p.z() - kOrigin.z(), ground.ground, 2e-4);
}

TEST(Mapper, ResultsDoNotDependOnTheNumberOfThreads) {
  const GroundAndDrive ground;
  const auto map_on = [&](int threads) { return test::on_threads(threads, [&] { return ground.map(vmx250()); }); };
  const Survey a = map_on(1), b = map_on(3);
  EXPECT_EQ(a.cloud.positions, b.cloud.positions);
  EXPECT_EQ(a.cloud.colors, b.cloud.colors);
  EXPECT_EQ(a.cloud.intensities, b.cloud.intensities);
  EXPECT_EQ(a.truth, b.truth);
}

}  // namespace
}  // namespace vdbmap::simulator
