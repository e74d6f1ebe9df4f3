// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/lidar.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vdbmap::simulator {
namespace {

using std::numbers::pi;

constexpr double kMountingHeight = 1.73;       // [m] above the ground, as on KITTI's car
constexpr double kBloomingReflectivity = 1.2;  // from here on a surface blooms
constexpr double kFarthestBlooming = 40;       // [m]

double radians(double degrees) { return degrees * pi / 180; }

Eigen::Isometry3d mounting() { return Eigen::Isometry3d(Eigen::Translation3d(0, 0, kMountingHeight)); }

// Velodyne's intensities: diffuse reflectances to 100, retroreflectors above.
float velodyne_intensity(double reflectivity) {
  const double value = reflectivity <= 1 ? 100 * reflectivity : 100 + 100 * (reflectivity - 1);
  return static_cast<float>(std::clamp(std::round(value), 0.0, 255.0));
}

void append_echo(Survey& scan, const SceneView& view, const Eigen::Vector3d& direction, const Echo& echo, double time,
                 std::uint16_t ring) {
  // In floats, as a driver gives them; so a PCD file takes 32 bits a coordinate.
  scan.cloud.positions.emplace_back((echo.range * direction).cast<float>().cast<double>());
  scan.cloud.intensities.push_back(velodyne_intensity(echo.reflectivity));
  scan.cloud.times.push_back(time);
  scan.cloud.rings.push_back(ring);
  scan.truth.push_back(view.truth(echo.triangle));
}

// All pulses of a turn, by firing and laser.
using Turn = std::vector<std::optional<Echo>>;

Turn measure_turn(const SceneView& view, const Drive& drive, const LidarModel& lidar, double start_time,
                  std::uint64_t seed) {
  Turn turn;
  turn.reserve(static_cast<std::size_t>(lidar.num_firings) * lidar.lasers.size());
  for (int firing = 0; firing < lidar.num_firings; ++firing) {
    for (Laser laser : lidar.lasers) {
      const double since_start = lidar.firing_time(firing, laser);
      const Eigen::Isometry3d scene_from_scanner =
          drive.scene_from_vehicle(start_time + since_start) * lidar.vehicle_from_scanner;
      laser.elevation += laser.elevation_error;
      const Eigen::Vector3d direction = lidar.direction(laser, since_start);
      RayRandom random(hash(seed, turn.size()));
      turn.push_back(measure(view.at(start_time + since_start), lidar.pulse, scene_from_scanner.translation(),
                             scene_from_scanner.linear() * direction, random));
      if (turn.back()) turn.back()->range += laser.range_bias;
    }
  }
  return turn;
}

// The index of the laser of each ring.
std::vector<std::size_t> lasers_by_ring(const LidarModel& lidar) {
  std::vector<std::size_t> lasers(lidar.lasers.size());
  for (std::size_t i = 0; i < lasers.size(); ++i) lasers[lidar.lasers[i].ring] = i;
  return lasers;
}

// The light of a retroreflector that scatters in the lens: neighbours of its pulses measure its distance too, as points
// of no surface.
void bloom(Turn& turn, const LidarModel& lidar, std::uint64_t seed) {
  const Turn sharp = turn;
  const std::vector<std::size_t> lasers = lasers_by_ring(lidar);
  const int num_lasers = static_cast<int>(lasers.size());
  Random random(hash(seed, 17));
  for (std::size_t i = 0; i < sharp.size(); ++i) {
    if (!sharp[i] || sharp[i]->reflectivity < kBloomingReflectivity || sharp[i]->range > kFarthestBlooming) continue;
    const int firing = static_cast<int>(i) / num_lasers;
    const int ring = lidar.lasers[i % lasers.size()].ring;
    for (int f = std::max(0, firing - 2); f <= std::min(lidar.num_firings - 1, firing + 2); ++f) {
      for (int r = std::max(0, ring - 1); r <= std::min(num_lasers - 1, ring + 1); ++r) {
        auto& other = turn[static_cast<std::size_t>(f * num_lasers) + lasers[static_cast<std::size_t>(r)]];
        if (!random.chance(lidar.blooming)) continue;
        if (other && other->range < sharp[i]->range + 0.3) continue;
        other = Echo{sharp[i]->range + random.normal(0, 0.04), kNoTriangle, sharp[i]->normal, 0.3};
      }
    }
  }
}

}  // namespace

double LidarModel::azimuth(double time) const { return 2 * pi * time / turn_time; }

Eigen::Vector3d LidarModel::direction(const Laser& laser, double time) const {
  const double angle = azimuth(time);
  return {std::cos(laser.elevation) * std::cos(angle), -std::cos(laser.elevation) * std::sin(angle),
          std::sin(laser.elevation)};
}

double LidarModel::firing_time(int firing, const Laser& laser) const {
  return turn_time * firing / num_firings + laser.delay;
}

LidarModel vlp16() {
  LidarModel lidar{{}, 1800, 0.1, {}, mounting()};
  // Lasers fire in the order -15, 1, -13, 3, ... degrees, 2.304 us apart (Velodyne 63-9243, section 9.3).
  for (int i = 0; i < 16; ++i) {
    const int ring = i % 2 == 0 ? i / 2 : 8 + i / 2;
    lidar.lasers.push_back({radians(-15 + 2 * ring), 2.304e-6 * i, static_cast<std::uint16_t>(ring), 0});
  }
  lidar.pulse = {
      .nearest = 0.5, .farthest = 100, .range_noise = 0.03, .divergence = 0.003, .half_range = 55, .random_loss = 0.01};
  return lidar;
}

LidarModel hdl64() {
  LidarModel lidar{{}, 2083, 0.1, {}, mounting()};
  Random biases(64);  // of one scanner, the same in every simulation
  for (int i = 0; i < 64; ++i) {
    const double elevation_deg = i < 32 ? 2 - i / 3.0 : -8.83 - (i - 32) * 0.5;
    lidar.lasers.push_back(
        {radians(elevation_deg), 0.7e-6 * i, static_cast<std::uint16_t>(63 - i), biases.normal(0, 0.015)});
  }
  lidar.pulse = {
      .nearest = 0.9, .farthest = 80, .range_noise = 0.007, .divergence = 0.002, .half_range = 60, .random_loss = 0.05};
  return lidar;
}

LidarModel hdl32() {
  LidarModel lidar{{}, 2170, 0.1, {}, mounting()};
  // 1.152 us apart, the lower half and the upper half in turns (Velodyne 63-9113, appendix).
  for (int i = 0; i < 32; ++i) {
    const int ring = i % 2 == 0 ? i / 2 : 16 + i / 2;
    lidar.lasers.push_back({radians(-30.67 + 4 * ring / 3.0), 1.152e-6 * i, static_cast<std::uint16_t>(ring), 0});
  }
  lidar.pulse = {
      .nearest = 0.5, .farthest = 100, .range_noise = 0.02, .divergence = 0.003, .half_range = 55, .random_loss = 0.02};
  return lidar;
}

LidarModel os1_128() {
  LidarModel lidar{{}, 1024, 0.1, {}, mounting()};
  for (int ring = 0; ring < 128; ++ring) {
    lidar.lasers.push_back({radians(-22.5 + 45 * ring / 127.0), 0, static_cast<std::uint16_t>(ring), 0});
  }
  lidar.pulse = {.nearest = 0.5,
                 .farthest = 120,
                 .range_noise = 0.015,
                 .divergence = 0.006,
                 .half_range = 70,
                 .random_loss = 0.02};
  return lidar;
}

LidarModel with_errors(LidarModel lidar, std::uint64_t seed) {
  Random random(hash(seed, 93));
  for (Laser& laser : lidar.lasers) {
    laser.range_bias = std::clamp(laser.range_bias + random.normal(0, 0.008), -0.02, 0.02);
    laser.elevation_error = radians(std::clamp(random.normal(0, 0.05), -0.1, 0.1));
  }
  lidar.clock_error = random.uniform(-0.001, 0.001);
  lidar.blooming = 0.3;
  return lidar;
}

Survey scan_turn(const SceneView& view, const Drive& drive, const LidarModel& lidar, double start_time,
                 std::uint64_t seed) {
  Turn turn = measure_turn(view, drive, lidar, start_time, seed);
  if (lidar.blooming > 0) bloom(turn, lidar, seed);
  Survey scan;
  for (std::size_t i = 0; i < turn.size(); ++i) {
    if (!turn[i]) continue;
    const Laser& laser = lidar.lasers[i % lidar.lasers.size()];
    const double since_start = lidar.firing_time(static_cast<int>(i / lidar.lasers.size()), laser);
    append_echo(scan, view, lidar.direction(laser, since_start), *turn[i], start_time + since_start + lidar.clock_error,
                laser.ring);
  }
  return scan;
}

}  // namespace vdbmap::simulator
