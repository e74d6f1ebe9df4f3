// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/street_axis.h"

#include <cmath>
#include <numbers>

namespace vdbmap::simulator {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;  // [rad]

}  // namespace

double StreetAxis::heading_at(double station) const {
  const double wave = kTurn / bend_length;
  return heading + std::atan(bend_amplitude * wave * std::cos(wave * station + bend_phase));
}

Eigen::Vector2d StreetAxis::point(double station, double offset) const {
  const double aside = bend_amplitude * (std::sin(kTurn / bend_length * station + bend_phase) - std::sin(bend_phase));
  const double direction = heading_at(station);
  const Eigen::Vector2d from_start(
      std::cos(heading) * station - std::sin(heading) * aside - std::sin(direction) * offset,
      std::sin(heading) * station + std::cos(heading) * aside + std::cos(direction) * offset);
  return start + from_start;
}

double StreetAxis::height(double station) const {
  if (hills) return hills->height(point(station, 0));
  return slope * station + sag_amplitude * std::sin(kTurn / sag_length * station);
}

StreetAxis make_axis(Random& random) {
  StreetAxis axis;
  axis.origin = {std::round(random.uniform(548'000, 553'000)), std::round(random.uniform(5'801'000, 5'806'000)),
                 std::round(random.uniform(50, 60))};
  axis.heading = random.uniform(0, kTurn);
  axis.bend_amplitude = random.uniform(0.3, 1.8);
  axis.bend_length = random.uniform(200, 320);
  axis.bend_phase = random.uniform(0, kTurn);
  axis.slope = random.uniform(0.004, 0.02) * (random.chance(0.5) ? 1 : -1);
  axis.sag_amplitude = random.uniform(0.05, 0.3);
  axis.sag_length = random.uniform(90, 200);
  return axis;
}

StreetAxis make_rough_axis(Random& random) {
  StreetAxis axis = make_axis(random);
  axis.bend_amplitude *= random.uniform(1, 2.5);
  axis.slope *= random.uniform(0.5, 2.5);
  axis.sag_amplitude *= random.uniform(1, 2);
  return axis;
}

}  // namespace vdbmap::simulator
