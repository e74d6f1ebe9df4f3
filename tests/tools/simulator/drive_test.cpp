// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/drive.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace vdbmap::simulator {
namespace {

struct Limits {
  double speed_min = 100, speed_max = 0;  // [m/s]
  double acceleration = 0;                // [m/s^2] along the drive
  double pitch = 0, roll = 0;             // [rad] against the horizon
};

Limits limits_of(const Drive& drive) {
  constexpr double kStep = 0.1;  // [s] longer than the springs' sway
  Limits limits;
  double speed_before = 0;
  for (double t = drive.start_time(); t + kStep < drive.end_time(); t += kStep) {
    const Eigen::Isometry3d a = drive.scene_from_vehicle(t);
    const Eigen::Isometry3d b = drive.scene_from_vehicle(t + kStep);
    const double speed = (b.translation() - a.translation()).head<2>().norm() / kStep;
    limits.speed_min = std::min(limits.speed_min, speed);
    limits.speed_max = std::max(limits.speed_max, speed);
    if (t > drive.start_time()) {
      limits.acceleration = std::max(limits.acceleration, std::abs(speed - speed_before) / kStep);
    }
    limits.pitch = std::max(limits.pitch, std::abs(std::asin(a.linear()(2, 0))));
    limits.roll = std::max(limits.roll, std::abs(std::asin(a.linear()(2, 1))));
    speed_before = speed;
  }
  return limits;
}

TEST(Drive, AcceleratesPitchesAndRollsLikeACar) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const StreetLayout layout = make_layout({.seed = seed, .is_ideal = true});
    const Limits limits = limits_of(Drive(layout, {.from = 10, .to = 165, .speed = 9, .seed = seed}));
    EXPECT_GT(limits.speed_min, 5);
    EXPECT_LT(limits.speed_max, 13);
    EXPECT_GT(limits.acceleration, 0.3);
    EXPECT_LT(limits.acceleration, 3);  // what passengers bear
    EXPECT_GT(limits.pitch, 0.002);
    EXPECT_LT(limits.pitch, 0.05);
    EXPECT_GT(limits.roll, 0.002);
    EXPECT_LT(limits.roll, 0.06);
  }
}

TEST(Drive, GoesFromItsFirstStationToItsLast) {
  const StreetLayout layout = make_layout({.is_ideal = true});
  const Drive drive(layout, {.from = 20, .to = 120, .speed = 9, .start_time = 1000});
  EXPECT_EQ(drive.start_time(), 1000);
  const auto distance_to = [&](double time, double station) {
    return (drive.scene_from_vehicle(time).translation().head<2>() - layout.axis.point(station, -0.8)).norm();
  };
  EXPECT_LT(distance_to(drive.start_time(), 20), 0.5);  // it does not keep quite to its lane
  EXPECT_LT(distance_to(drive.end_time(), 120), 2);     // nor stop on the spot
}

// Between poses a millisecond apart, where the fastest sway is 4 Hz, nothing jumps.
TEST(Drive, PosesAreSmooth) {
  const StreetLayout layout = make_layout({.is_ideal = true});
  const Drive drive(layout, {.from = 20, .to = 60});
  for (double t = 1; t < 3; t += 0.00037) {
    const Eigen::Isometry3d a = drive.scene_from_vehicle(t), b = drive.scene_from_vehicle(t + 0.00037);
    EXPECT_LT((b.translation() - a.translation()).norm(), 0.00037 * 13);
    EXPECT_LT(Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle(), 0.00037 * 0.3);
  }
}

}  // namespace
}  // namespace vdbmap::simulator
