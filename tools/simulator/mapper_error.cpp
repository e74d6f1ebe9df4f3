// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/mapper_error.h"

#include <cmath>
#include <numbers>

#include "tools/simulator/random.h"

namespace vdbmap::simulator {
namespace {

using std::numbers::pi;

double value(const MapperError::Wave& wave, double distance) {
  return wave.amplitude * std::sin(2 * pi * distance / wave.length + wave.phase);
}

MapperError::Wave make_wave(double low, double high, double shortest, double longest, Random& random) {
  return {random.uniform(low, high), random.uniform(shortest, longest), random.uniform(0, 2 * pi)};
}

Eigen::Quaterniond small_rotation(const Eigen::Vector3d& angles) {
  const double angle = angles.norm();
  if (angle == 0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, angles / angle));
}

Eigen::Vector3d normal_vector(double deviation, Random& random) {
  const double x = random.normal(0, deviation), y = random.normal(0, deviation);
  return {x, y, random.normal(0, deviation)};
}

}  // namespace

Eigen::Isometry3d MapperError::estimated(const Eigen::Isometry3d& scene_from_vehicle, double distance) const {
  Eigen::Isometry3d pose = scene_from_vehicle;
  for (int axis = 0; axis < 3; ++axis) {
    const auto& waves = drift[static_cast<std::size_t>(axis)];
    pose.translation()[axis] += value(waves[0], distance) + value(waves[1], distance);
  }
  pose.rotate(
      small_rotation({value(attitude[0], distance), value(attitude[1], distance), value(attitude[2], distance)}));
  return pose;
}

Eigen::Isometry3d MapperError::estimated_mounting(const Eigen::Isometry3d& vehicle_from_scanner,
                                                  std::size_t scanner) const {
  Eigen::Isometry3d mounting = vehicle_from_scanner;
  mounting.translation() += lever_arm[scanner];
  mounting.rotate(small_rotation(boresight[scanner]));
  return mounting;
}

MapperError make_mapper_error(std::uint64_t seed) {
  Random random(hash(seed, 91));
  MapperError error;
  for (auto& axis : error.drift) {
    axis = {make_wave(0.012, 0.025, 160, 280, random), make_wave(0.001, 0.004, 45, 90, random)};
  }
  for (auto& axis : error.attitude) axis = make_wave(0.0001, 0.0003, 100, 250, random);
  for (auto& angles : error.boresight) angles = normal_vector(0.00012, random);
  // Half of the gap between the scanners is each one's.
  Eigen::Vector3d gap = normal_vector(1, random).normalized() * random.uniform(0.007, 0.012);
  gap.z() *= 0.5;
  const Eigen::Vector3d common = normal_vector(0.004, random);
  error.lever_arm = {common + gap / 2, common - gap / 2};
  for (double& gain : error.intensity_gain) gain = random.uniform(0.85, 1.15);
  const double exposure = random.uniform(0.8, 1.15);
  error.color_gain = {exposure * random.uniform(0.95, 1.05), exposure, exposure * random.uniform(0.93, 1.07)};
  error.has_camera_blunders = true;
  return error;
}

}  // namespace vdbmap::simulator
