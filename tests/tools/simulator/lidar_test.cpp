// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/lidar.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "tests/tools/simulator/simple_scene.h"

namespace vdbmap::simulator {
namespace {

using std::numbers::pi;

constexpr double kDegree = pi / 180;

TEST(Lidar, Vlp16HasSixteenBeamsTwoDegreesApart) {
  const LidarModel lidar = vlp16();
  std::set<int> rings;
  for (const Laser& laser : lidar.lasers) {
    rings.insert(laser.ring);
    EXPECT_NEAR(laser.elevation / kDegree, -15 + 2 * laser.ring, 1e-9);
  }
  EXPECT_EQ(rings.size(), 16U);
  EXPECT_NEAR(lidar.azimuth(lidar.firing_time(1, lidar.lasers[0])) / kDegree, 0.2, 1e-9);
  EXPECT_NEAR(lidar.turn_time, 0.1, 1e-12);
}

TEST(Lidar, Hdl64HasTwoBlocksOfThirtyTwoBeams) {
  const LidarModel lidar = hdl64();
  ASSERT_EQ(lidar.lasers.size(), 64U);
  EXPECT_NEAR(lidar.lasers.front().elevation / kDegree, 2, 1e-9);
  EXPECT_NEAR(lidar.lasers.back().elevation / kDegree, -24.33, 1e-9);
  EXPECT_TRUE(std::ranges::is_sorted(lidar.lasers, std::greater(), &Laser::elevation));
  EXPECT_TRUE(std::ranges::is_sorted(lidar.lasers, std::greater(), &Laser::ring));
}

// Forward at first, to the right a quarter of a turn later: clockwise seen from above.
TEST(Lidar, TurnsClockwiseFromItsFront) {
  const LidarModel lidar = vlp16();
  const Laser level = {0, 0, 0};
  EXPECT_TRUE(lidar.direction(level, 0).isApprox(Eigen::Vector3d::UnitX(), 1e-12));
  EXPECT_TRUE(lidar.direction(level, lidar.turn_time / 4).isApprox(-Eigen::Vector3d::UnitY(), 1e-12));
}

// Ground and a wall with equations, and a drive between them; nothing of a street.
struct PlanesAndDrive {
  PlanesAndDrive() {
    const Eigen::Vector3d from = drive.scene_from_vehicle(0).translation();
    const Eigen::Vector3d along = drive.scene_from_vehicle(2).translation() - from;
    wall_normal = Eigen::Vector3d(-along.y(), along.x(), 0).normalized();
    wall_distance = wall_normal.dot(from) + 6;
    ground = from.z() - 1;
    const Eigen::Vector3d foot = from + 6 * wall_normal;
    const Eigen::Vector3d reach = 60 * along.normalized();
    add_quad(scene.brush(0.5F), foot - reach, foot + reach, foot + reach + Eigen::Vector3d(0, 0, 20),
             foot - reach + Eigen::Vector3d(0, 0, 20));
    const Eigen::Vector3d side = 60 * wall_normal;
    const auto at_ground = [&](const Eigen::Vector3d& p) { return Eigen::Vector3d(p.x(), p.y(), ground); };
    add_quad(scene.brush(0.5F), at_ground(from - reach - side), at_ground(from + reach - side),
             at_ground(from + reach + side), at_ground(from - reach + side));
  }

  // Distance of a point [scene frame] to the nearer of the two planes.
  double distance(const Eigen::Vector3d& point) const {
    return std::min(std::abs(wall_normal.dot(point) - wall_distance), std::abs(point.z() - ground));
  }

  StreetLayout layout = make_layout({.is_ideal = true});
  Drive drive{layout, {.from = 50, .to = 80, .speed = 9, .seed = 3}};
  SimpleScene scene;
  Eigen::Vector3d wall_normal;
  double wall_distance = 0;
  double ground = 0;
};

Survey scan_planes(const PlanesAndDrive& planes, LidarModel lidar) {
  lidar.pulse = {.farthest = 40};  // neither noise nor losses
  for (Laser& laser : lidar.lasers) laser.range_bias = 0;
  const RayCaster caster(planes.scene.mesh);
  return scan_turn({planes.scene.mesh, planes.scene.materials, caster}, planes.drive, lidar, 0.5, 1);
}

TEST(Lidar, NoiseFreePointsLieOnTheSurfacesByThePoseAtTheirTime) {
  const PlanesAndDrive planes;
  for (const LidarModel& lidar : {vlp16(), hdl64()}) {
    const Survey scan = scan_planes(planes, lidar);
    ASSERT_GT(scan.cloud.size(), 10'000U);
    for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
      const Eigen::Isometry3d scene_from_scanner =
          planes.drive.scene_from_vehicle(scan.cloud.times[i]) * lidar.vehicle_from_scanner;
      // Floats of a scene 200 m wide, twice rounded.
      ASSERT_LT(planes.distance(scene_from_scanner * scan.cloud.positions[i]), 5e-4) << i;
    }
  }
}

// Without the motion the same points miss the surfaces by decimetres: the scan really is taken while driving.
TEST(Lidar, PointsAreSmearedByThePoseOfTheFirst) {
  const PlanesAndDrive planes;
  const Survey scan = scan_planes(planes, vlp16());
  const Eigen::Isometry3d first =
      planes.drive.scene_from_vehicle(scan.cloud.times.front()) * vlp16().vehicle_from_scanner;
  double worst = 0;
  for (const Eigen::Vector3d& point : scan.cloud.positions) worst = std::max(worst, planes.distance(first * point));
  EXPECT_GT(worst, 0.03);
}

TEST(Lidar, PointsComeInTheOrderOfTimeWithTheAzimuthOfTheirTime) {
  const PlanesAndDrive planes;
  const LidarModel lidar = vlp16();
  const Survey scan = scan_planes(planes, lidar);
  EXPECT_TRUE(std::ranges::is_sorted(scan.cloud.times));
  EXPECT_LT(scan.cloud.times.back() - scan.cloud.times.front(), 0.1);
  for (std::size_t i = 0; i < scan.cloud.size(); i += 97) {
    const Eigen::Vector3d& p = scan.cloud.positions[i];
    const double azimuth = std::remainder(-std::atan2(p.y(), p.x()) - lidar.azimuth(scan.cloud.times[i] - 0.5), 2 * pi);
    EXPECT_NEAR(azimuth, 0, 1e-5);
    EXPECT_NEAR(std::asin(p.z() / p.norm()), lidar.lasers[0].elevation + 2 * kDegree * scan.cloud.rings[i], 1e-5);
  }
}

TEST(LidarErrors, StayWithinTwoCentimetresATenthOfADegreeAndAMillisecond) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const LidarModel lidar = with_errors(hdl64(), seed);
    double largest_bias = 0, largest_angle = 0;
    for (const Laser& laser : lidar.lasers) {
      largest_bias = std::max(largest_bias, std::abs(laser.range_bias));
      largest_angle = std::max(largest_angle, std::abs(laser.elevation_error) / kDegree);
    }
    EXPECT_GT(largest_bias, 0.01);
    EXPECT_LE(largest_bias, 0.02);
    EXPECT_GT(largest_angle, 0.05);
    EXPECT_LE(largest_angle, 0.1 + 1e-9);
    EXPECT_LE(std::abs(lidar.clock_error), 0.001);
    EXPECT_NE(lidar.clock_error, 0);
  }
}

// A beam that looks higher than the scanner believes measures the ground farther away, but says the elevation it
// believes.
TEST(LidarErrors, ElevationsAreWhatTheScannerBelievesAndRangesWhatIsThere) {
  const PlanesAndDrive planes;
  LidarModel lidar = vlp16();
  const Survey right = scan_planes(planes, lidar);
  for (Laser& laser : lidar.lasers) laser.elevation_error = 0.1 * kDegree;
  lidar.clock_error = 0.0005;
  const Survey wrong = scan_planes(planes, lidar);
  // The lowest beam to the right, where there is no wall.
  const auto mean_range = [](const Survey& scan) {
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
      const Eigen::Vector3d& p = scan.cloud.positions[i];
      if (scan.cloud.rings[i] != 0 || p.y() > -2) continue;
      EXPECT_NEAR(std::asin(p.normalized().z()), -15 * kDegree, 1e-5);
      sum += p.norm();
      ++count;
    }
    EXPECT_GT(count, 300);
    return sum / count;
  };
  // At 15 degrees down the range to level ground grows by cot(15 degrees) * 0.1 degrees.
  EXPECT_NEAR(mean_range(wrong) / mean_range(right), 1 + 0.1 * kDegree / std::tan(15 * kDegree), 0.0005);
  EXPECT_NEAR(wrong.cloud.times.front() - right.cloud.times.front(), 0.0005, 1e-9);
}

// A small bright plate before a wall: beside it some pulses measure the plate's distance, and belong to nothing.
TEST(LidarErrors, RetroreflectorsBloom) {
  PlanesAndDrive planes;
  const Eigen::Isometry3d scanner = planes.drive.scene_from_vehicle(0.5) * vlp16().vehicle_from_scanner;
  Brush plate = planes.scene.brush(2.0F);
  plate.scene_from_part = scanner;
  add_quad(plate, {8, -0.4, -0.4}, {8, 0.4, -0.4}, {8, 0.4, 0.4}, {8, -0.4, 0.4});
  LidarModel lidar = vlp16();
  lidar.blooming = 0.5;
  const Survey scan = scan_planes(planes, lidar);
  int num_ghosts = 0;
  for (std::size_t i = 0; i < scan.truth.size(); ++i) {
    if (scan.truth[i].label != static_cast<std::uint16_t>(SurfaceClass::kOutlier)) continue;
    ++num_ghosts;
    EXPECT_NEAR(scan.cloud.positions[i].norm(), 8, 1);  // the scanner drives 0.9 m during the turn
  }
  EXPECT_GT(num_ghosts, 3);
  EXPECT_LT(num_ghosts, 120);
}

TEST(Lidar, NamedScannersHaveTheBeamsOfTheirSheets) {
  const LidarModel thirty_two = hdl32();
  ASSERT_EQ(thirty_two.lasers.size(), 32U);
  const auto [low, high] = std::ranges::minmax(thirty_two.lasers, {}, &Laser::elevation);
  EXPECT_NEAR(low.elevation / kDegree, -30.67, 0.01);
  EXPECT_NEAR(high.elevation / kDegree, 10.67, 0.01);
  const LidarModel ouster = os1_128();
  ASSERT_EQ(ouster.lasers.size(), 128U);
  EXPECT_NEAR(ouster.lasers.back().elevation / kDegree, 22.5, 1e-9);
}

}  // namespace
}  // namespace vdbmap::simulator
