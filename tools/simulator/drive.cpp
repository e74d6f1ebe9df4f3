// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/drive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "vdbmap/core/parallel.h"

namespace vdbmap::simulator {
namespace {

using std::numbers::pi;

constexpr double kPeriod = 0.001;          // [s] between poses
constexpr double kLane = -0.8;             // [m] right of the axis: between parked cars one keeps to the middle
constexpr double kWheelbase = 2.9;         // [m]
constexpr double kTrack = 1.6;             // [m]
constexpr double kPitchByBraking = 0.005;  // [rad s^2/m] nose down
constexpr double kRollBySwerving = 0.006;  // [rad s^2/m] outwards

// amplitude * sin(frequency * time + phase)
struct Wave {
  double amplitude;
  double frequency;  // [rad/s]
  double phase;      // [rad]

  double value(double time) const { return amplitude * std::sin(frequency * time + phase); }
  double rate(double time) const { return amplitude * frequency * std::cos(frequency * time + phase); }
  double acceleration(double time) const { return -frequency * frequency * value(time); }
};

Wave make_wave(double amplitude, double period, Random& random) {
  return {amplitude * random.uniform(0.7, 1.3), 2 * pi / (period * random.uniform(0.8, 1.25)),
          random.uniform(0, 2 * pi)};
}

class Motion {
 public:
  Motion(const Route& route, const DriveOptions& options)
      : route_(route), options_(options), random_(hash(options.seed, 51)) {
    // The speed swings by some 15 %: for 9 m/s up to 1 m/s^2.
    const double swing = options.speed * 0.15;
    along_ = {make_wave(swing * 8 / (2 * pi), 8, random_), make_wave(swing * 0.6 * 4.5 / (2 * pi), 4.5, random_)};
    aside_ = {make_wave(0.22, 11, random_), make_wave(0.05, 4, random_)};
    pitch_ = {make_wave(0.0030, 0.75, random_), make_wave(0.0010, 0.31, random_)};
    roll_ = {make_wave(0.0035, 0.95, random_), make_wave(0.0012, 0.37, random_)};
    heave_ = {make_wave(0.008, 0.8, random_), make_wave(0.002, 0.29, random_)};
  }

  double station(double time) const {
    return options_.from + options_.speed * time + sum(along_, time, &Wave::value) - sum(along_, 0, &Wave::value);
  }

  Eigen::Isometry3d pose(double time) const {
    const double s = station(time);
    const double offset = kLane + sum(aside_, time, &Wave::value);
    const double speed = options_.speed + sum(along_, time, &Wave::rate);
    const double yaw = std::atan2(sum(aside_, time, &Wave::rate), speed);
    Eigen::Isometry3d pose = route_.place(s, offset, yaw);
    const double rise = height(s + kWheelbase / 2, offset) - height(s - kWheelbase / 2, offset);
    const double bank = height(s, offset + kTrack / 2) - height(s, offset - kTrack / 2);
    const double nose_up = std::atan(rise / kWheelbase) + sum(pitch_, time, &Wave::value) +
                           kPitchByBraking * sum(along_, time, &Wave::acceleration);
    const double left_up = std::atan(bank / kTrack) + sum(roll_, time, &Wave::value) +
                           kRollBySwerving * sum(aside_, time, &Wave::acceleration);
    pose.translation().z() += sum(heave_, time, &Wave::value);
    pose.rotate(Eigen::AngleAxisd(-nose_up, Eigen::Vector3d::UnitY()));
    pose.rotate(Eigen::AngleAxisd(left_up, Eigen::Vector3d::UnitX()));
    return pose;
  }

 private:
  using Waves = std::array<Wave, 2>;

  static double sum(const Waves& waves, double time, double (Wave::*what)(double) const) {
    return (waves[0].*what)(time) + (waves[1].*what)(time);
  }
  double height(double s, double offset) const { return route_.height(s, offset); }

  const Route& route_;
  const DriveOptions& options_;
  Random random_;
  Waves along_, aside_, pitch_, roll_, heave_;
};

}  // namespace

Drive::Drive(const Route& route, const DriveOptions& options) : start_time_(options.start_time) {
  const Motion motion(route, options);
  double duration = options.shortest_time;
  while (motion.station(duration) < options.to) duration += 0.1;
  poses_.resize(static_cast<std::size_t>(std::ceil(duration / kPeriod)) + 2);
  parallel_for(
      poses_.size(),
      [&](std::size_t i) {
        const Eigen::Isometry3d pose = motion.pose(static_cast<double>(i) * kPeriod);
        poses_[i] = {pose.translation(), Eigen::Quaterniond(pose.linear())};
      },
      256);
}

double Drive::end_time() const { return start_time_ + static_cast<double>(poses_.size() - 1) * kPeriod; }

Eigen::Isometry3d Drive::scene_from_vehicle(double time) const {
  const double place = std::clamp((time - start_time_) / kPeriod, 0.0, static_cast<double>(poses_.size() - 1));
  const std::size_t before = std::min(static_cast<std::size_t>(place), poses_.size() - 2);
  const double share = place - static_cast<double>(before);
  const Pose& a = poses_[before];
  const Pose& b = poses_[before + 1];
  Eigen::Isometry3d pose(a.rotation.slerp(share, b.rotation));
  pose.translation() = (1 - share) * a.position + share * b.position;
  return pose;
}

}  // namespace vdbmap::simulator
