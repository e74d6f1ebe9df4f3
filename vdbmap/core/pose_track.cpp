// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/pose_track.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace vdbmap {

PoseTrack::PoseTrack(const std::vector<std::optional<Eigen::Isometry3d>>& map_from_sensor,
                     const std::vector<double>& times) {
  if (map_from_sensor.size() != times.size()) {
    throw std::invalid_argument("a trajectory of " + std::to_string(map_from_sensor.size()) + " poses has " +
                                std::to_string(times.size()) + " times");
  }
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!map_from_sensor[i] || !std::isfinite(times[i])) continue;
    poses_.push_back({times[i], map_from_sensor[i]->translation(), Eigen::Quaterniond(map_from_sensor[i]->linear())});
  }
  std::ranges::stable_sort(poses_, {}, &Pose::time);
  const auto same_time = [](const Pose& a, const Pose& b) { return a.time == b.time; };
  for (auto twice = std::ranges::adjacent_find(poses_, same_time); twice != poses_.end();
       twice = std::adjacent_find(twice + 1, poses_.end(), same_time)) {
    if (twice->position != (twice + 1)->position) {
      throw std::invalid_argument("a trajectory has two poses of time " + std::to_string(twice->time));
    }
  }
  poses_.erase(std::unique(poses_.begin(), poses_.end(), same_time), poses_.end());
  if (poses_.size() < 2) throw std::invalid_argument("a trajectory needs two poses with times at least");
}

std::optional<Eigen::Isometry3d> PoseTrack::at(double time, double max_gap) const {
  if (!(time >= first_time() && time <= last_time())) return std::nullopt;
  const auto after = std::ranges::upper_bound(poses_, time, {}, &Pose::time);
  const Pose& b = after == poses_.end() ? poses_.back() : *after;
  const Pose& a = *(&b - 1);
  if (b.time - a.time > max_gap) return std::nullopt;
  const double share = (time - a.time) / (b.time - a.time);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = a.rotation.slerp(share, b.rotation).toRotationMatrix();
  pose.translation() = a.position + share * (b.position - a.position);
  return pose;
}

}  // namespace vdbmap
