// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/odometry/deskew.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/support/moving_scanner.h"
#include "tests/support/random_points.h"
#include "tests/support/threads.h"

namespace vdbmap::registration {
namespace {

const Eigen::AlignedBox3d kSurroundings(Eigen::Vector3d(-50, -50, -3), Eigen::Vector3d(50, 50, 9));
constexpr double kEpoch = 1.7e9;  // [s] times as GPS and Unix clocks give them

ScanMotion scan_motion(const Eigen::Vector3d& turn, const Eigen::Vector3d& velocity) {
  ScanMotion motion{kEpoch, Vector6d::Zero()};
  motion.twist << turn, velocity;
  return motion;
}

TEST(Deskew, MovesEveryPointByTheMotionUntilItsTime) {
  const std::vector<Eigen::Vector3d> points = test::random_points(3000, kSurroundings, 1);
  for (const ScanMotion& sensor : {scan_motion({0.3, -0.2, 1.5}, {15, 1, -0.5}), scan_motion({0, 0, 0}, {15, 1, -0.5}),
                                   scan_motion({0, 0, 1e-8}, {15, 0, 0}), scan_motion({0, 2, 0}, {0, 0, 0})}) {
    std::vector<double> times;
    for (std::size_t i = 0; i < points.size(); ++i) times.push_back(kEpoch + 0.1 * static_cast<double>(i) / 3000);
    const std::vector<Eigen::Vector3d> deskewed = deskew_points(points, times, sensor);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d expected = motion_of_twist((times[i] - kEpoch) * sensor.twist) * points[i];
      EXPECT_NEAR((deskewed[i] - expected).norm(), 0, 1e-9) << i;  // [m] the cosine of 1e-9 rad is that of 0
    }
  }
}

TEST(Deskew, OfAMovingScannersScanLiesOnTheScene) {
  const Eigen::Vector3d start(-5, 0.3, 1.8);
  const ScanMotion sensor = scan_motion({0.02, -0.03, 0.6}, {12, 0.4, 0.1});
  const auto map_from_sensor_at = [&](double time) {
    return Eigen::Isometry3d(Eigen::Translation3d(start) * motion_of_twist((time - kEpoch) * sensor.twist));
  };
  const test::Scene ground = {{{-100, -100, 0}, {200, 0, 0}, {0, 200, 0}}};
  const PointCloud scan = test::scan_while_moving(ground, map_from_sensor_at, kEpoch, 0.1);
  ASSERT_GT(scan.size(), 10'000U);
  const PointCloud deskewed = deskew(scan, sensor);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    // Times of 1.7e9 s are kept to 0.2 microseconds, in which the sensor moves 3 micrometres.
    ASSERT_NEAR((map_from_sensor_at(kEpoch) * deskewed.positions[i]).z(), 0, 1e-5) << i;
  }
}

TEST(Deskew, WithoutTimesOrMotionTheScanStaysAsItIs) {
  PointCloud scan;
  scan.positions = test::random_points(10, kSurroundings, 1);
  EXPECT_EQ(deskew(scan, scan_motion({0, 0, 1}, {1, 0, 0})).positions, scan.positions);
  scan.times.assign(10, kEpoch + 0.05);
  EXPECT_EQ(deskew(scan, scan_motion({0, 0, 0}, {0, 0, 0})).positions, scan.positions);
}

TEST(Deskew, IsTheSameForAnyNumberOfThreads) {
  const std::vector<Eigen::Vector3d> points = test::random_points(20'000, kSurroundings, 1);
  const std::vector<double> times(points.size(), kEpoch + 0.07);
  const ScanMotion sensor = scan_motion({0.3, -0.2, 1.5}, {15, 1, -0.5});
  const auto deskewed = [&] { return deskew_points(points, times, sensor); };
  EXPECT_EQ(test::on_threads(1, deskewed), test::on_threads(4, deskewed));
}

TEST(Deskew, NeedsATimeForEveryPoint) {
  const std::vector<Eigen::Vector3d> points(3, Eigen::Vector3d::Zero());
  const std::vector<double> times(2, 0);
  EXPECT_THROW(deskew_points(points, times, {}), std::invalid_argument);
}

}  // namespace
}  // namespace vdbmap::registration
